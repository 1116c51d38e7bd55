#include "server/auth/live_sessions.hpp"

#include <chrono>
#include <stdexcept>

#include <gtest/gtest.h>

namespace kinectlab::auth {
namespace {

/// Gives the thread that looks the time it needs, and no more.
bool soon_over(LiveSessions& sessions, const LiveSessions::Stream& stream) {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!stream.over() && std::chrono::steady_clock::now() < patience) {
        sessions.look();
        std::this_thread::yield();
    }
    return stream.over();
}

TEST(LiveSessions, StreamsEndWithTheirSessionOnly) {
    std::atomic<bool> signed_in{true};
    LiveSessions sessions([&](const std::string& hash) { return hash != "a" || signed_in; });
    const auto first = sessions.watch("a");
    const auto second = sessions.watch("a");
    const auto other = sessions.watch("b");
    EXPECT_FALSE(first->over());
    signed_in = false;
    EXPECT_TRUE(soon_over(sessions, *first));
    EXPECT_TRUE(soon_over(sessions, *second));
    EXPECT_FALSE(other->over());
}

TEST(LiveSessions, BrokenStorageSignsNobodyOut) {
    std::atomic<bool> broken{true};
    std::atomic<int> asked{0};
    LiveSessions sessions([&](const std::string&) -> bool {
        ++asked;
        if (broken) throw std::runtime_error("disk I/O error");
        return false;
    });
    const auto stream = sessions.watch("a");
    while (asked == 0) {
        sessions.look();
        std::this_thread::yield();
    }
    EXPECT_FALSE(stream->over());
    broken = false;
    EXPECT_TRUE(soon_over(sessions, *stream));
}

}  // namespace
}  // namespace kinectlab::auth
