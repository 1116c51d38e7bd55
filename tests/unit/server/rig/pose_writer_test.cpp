#include "server/rig/pose_writer.hpp"

#include <gtest/gtest.h>

#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::rig {
namespace {

using test::kMinute;
using test::kNoon;

store::StoredPose pose(TimeNs t) {
    store::StoredPose pose{"bob", {}};
    pose.sample.t = t;
    return pose;
}

TEST(PoseWriter, WhatWasFlushedIsStored) {
    test::TemporaryStore store;
    const auto booking = store.add_booking(store.add_user("ada"), kNoon, kNoon + 30 * kMinute);
    const auto run = store.add_run(booking);
    PoseWriter writer(store->poses);
    for (TimeNs t = 0; t < 100; ++t)
        writer.append(run.id, pose(t));
    writer.flush();
    EXPECT_EQ(store->poses.count(run.id), 100U);
    EXPECT_FALSE(writer.take_error());
}

TEST(PoseWriter, ASmallQueueSlowsDownAndLosesNothing) {
    test::TemporaryStore store;
    const auto booking = store.add_booking(store.add_user("ada"), kNoon, kNoon + 30 * kMinute);
    const auto run = store.add_run(booking);
    {
        PoseWriter writer(store->poses, 7);
        for (TimeNs t = 0; t < 200; ++t)
            writer.append(run.id, pose(t));
    }  // stores what waits
    EXPECT_EQ(store->poses.count(run.id), 200U);
}

TEST(PoseWriter, TheRunsFramesAreStoredWithItsPoses) {
    test::TemporaryStore store;
    const auto booking = store.add_booking(store.add_user("ada"), kNoon, kNoon + 30 * kMinute);
    const auto run = store.add_run(booking);
    PoseWriter writer(store->poses);
    for (TimeNs t = 0; t < 100; ++t)
        writer.append(run.id, pose(t), store::FrameCounts{t + 1, t / 50});
    writer.flush();
    EXPECT_EQ(store->runs.find(run.id)->frames, 100);
    EXPECT_EQ(store->runs.find(run.id)->frames_lost, 1);
    store->poses.append(run.id, {}, store::FrameCounts{7, 0});
    EXPECT_EQ(store->runs.find(run.id)->frames, 100) << "counts never go back";
}

TEST(PoseWriter, TellsWhenPosesCouldNotBeStored) {
    test::TemporaryStore store;
    PoseWriter writer(store->poses);
    writer.append(99, pose(1));  // no such run: the foreign key refuses
    writer.flush();
    EXPECT_TRUE(writer.take_error());
    EXPECT_FALSE(writer.take_error());
}

}  // namespace
}  // namespace kinectlab::rig
