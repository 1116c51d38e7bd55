#include "server/auth/live_sessions.hpp"

#include <chrono>
#include <exception>
#include <map>

namespace kinectlab::auth {
namespace {

constexpr std::chrono::seconds kEvery{1};

}  // namespace

LiveSessions::LiveSessions(IsOpen is_open)
    : is_open_(std::move(is_open)), thread_([this] { work(); }) {}

LiveSessions::~LiveSessions() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

std::shared_ptr<const LiveSessions::Stream> LiveSessions::watch(const std::string& token_hash) {
    auto stream = std::make_shared<Stream>(token_hash);
    const std::lock_guard lock(mutex_);
    streams_.push_back(stream);
    return stream;
}

void LiveSessions::look() {
    {
        const std::lock_guard lock(mutex_);
        asked_ = true;
    }
    changed_.notify_all();
}

void LiveSessions::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait_for(lock, kEvery, [this] { return closing_ || asked_; });
        if (closing_) return;
        asked_ = false;
        std::vector<std::shared_ptr<Stream>> open;
        std::erase_if(streams_, [&](const auto& weak) {
            auto stream = weak.lock();
            const bool gone = !stream || stream->over();
            if (!gone) open.push_back(std::move(stream));
            return gone;
        });
        lock.unlock();
        check(open);
        lock.lock();
    }
}

void LiveSessions::check(const std::vector<std::shared_ptr<Stream>>& streams) const {
    std::map<std::string, bool> known;  // one person may watch in many tabs
    for (const auto& stream : streams) {
        const auto [session, is_new] = known.try_emplace(stream->session_, true);
        try {
            if (is_new) session->second = is_open_(stream->session_);
        } catch (const std::exception&) {
            // Broken storage signs nobody out; the next second asks again.
        }
        if (!session->second) stream->over_ = true;
    }
}

}  // namespace kinectlab::auth
