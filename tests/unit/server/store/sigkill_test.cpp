#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::store {
namespace {

using test::kNoon;
using test::TemporaryStore;

constexpr int kPosesInABatch = 15;

/// Writes batches of poses for ever and tells of each only after it was acknowledged.
[[noreturn]] void write_until_killed(
    const std::filesystem::path& file, lab::RunId run, std::int64_t first, int acknowledgements
) {
    try {
        Store store(file, test::migrations());
        for (std::int64_t batch = first;; ++batch) {
            std::vector<StoredPose> poses(kPosesInABatch, StoredPose{"bob", {}});
            for (int i = 0; i < kPosesInABatch; ++i) {
                poses[i].sample.t = kNoon + batch * kPosesInABatch + i;
            }
            store.poses.append(run, poses);
            store.runs.set_frames(run, (batch + 1) * kPosesInABatch, 0);
            const std::int64_t done = batch + 1;
            if (write(acknowledgements, &done, sizeof done) != sizeof done) _exit(1);
        }
    } catch (...) {
        _exit(2);
    }
}

/// The last number that the child wrote before it was killed.
std::int64_t last_acknowledged(int pipe, std::int64_t otherwise) {
    std::int64_t last = otherwise;
    std::int64_t number = 0;
    while (read(pipe, &number, sizeof number) == sizeof number)
        last = number;
    return last;
}

TEST(Sigkill, AtAnyMomentLosesNothingAcknowledgedAndBreaksNothing) {
    TemporaryStore setup;
    const auto ada = setup.add_user("ada");
    const auto booking = setup.add_booking(ada, kNoon, kNoon + 30 * test::kMinute);
    const auto run = setup.add_run(booking);
    std::mt19937 random(20261122);
    std::int64_t acknowledged = 0;
    for (int round = 0; round < 20; ++round) {
        std::array<int, 2> ends{};
        ASSERT_EQ(pipe(ends.data()), 0);
        const auto first = static_cast<std::int64_t>(setup->poses.count(run.id)) / kPosesInABatch;
        const pid_t child = fork();
        if (child == 0) {
            close(ends[0]);
            write_until_killed(setup.file(), run.id, first, ends[1]);
        }
        close(ends[1]);
        const int wait_ms = std::uniform_int_distribution<int>(30, 300)(random);
        std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
        ASSERT_EQ(kill(child, SIGKILL), 0);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status)) << "the writer failed by itself";
        acknowledged = last_acknowledged(ends[0], acknowledged);
        close(ends[0]);

        const auto after = setup.open();
        Database::Reader reader(after->database);
        EXPECT_EQ(reader.connection().execAndGet("PRAGMA integrity_check").getString(), "ok");
        const auto stored = static_cast<std::int64_t>(after->poses.count(run.id));
        EXPECT_GE(stored, acknowledged * kPosesInABatch);
        EXPECT_EQ(stored % kPosesInABatch, 0) << "half a batch was stored";
        EXPECT_GE(after->runs.find(run.id)->frames, acknowledged * kPosesInABatch);
    }
    EXPECT_GT(acknowledged, 20);
    EXPECT_EQ(setup->runs.interrupt_unfinished(kNoon, "killed").size(), 1U);
}

}  // namespace
}  // namespace kinectlab::store
