#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::store {
namespace {

using lab::RunEvent;
using lab::RunState;
using test::kMinute;
using test::kNoon;
using test::TemporaryStore;

class RunsTest : public testing::Test {
protected:
    RunsTest()
        : ada_(store_.add_user("ada")),
          booking_(store_.add_booking(ada_, kNoon, kNoon + 30 * kMinute)) {}

    void advance(lab::RunId run, RunEvent event, TimeNs at, const std::string& cause = "") {
        ASSERT_TRUE(store_->runs.advance(run, {event, at, cause, {}}));
    }

    TemporaryStore store_;
    lab::User ada_;
    lab::Booking booking_;
};

TEST_F(RunsTest, KeepWhatTheyWereStartedWith) {
    const auto run = store_.add_run(booking_);
    const auto found = store_->runs.find(run.id);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->state, RunState::preparing);
    EXPECT_EQ(found->user_name, "Display ada");
    EXPECT_EQ(found->booking, booking_.id);
    EXPECT_EQ(found->parameters, (lab::Parameters{{"length_m", 1.0}}));
    EXPECT_EQ(found->definition_json, test::pendulum_json());
    EXPECT_EQ(found->created, kNoon);
    EXPECT_EQ(found->release_until, kNoon + 5 * kMinute);
    EXPECT_FALSE(found->started);
    EXPECT_FALSE(found->ended);
    EXPECT_FALSE(store_->runs.find(run.id + 1));
}

TEST_F(RunsTest, EveryChangeIsKeptWithTimeCauseAndPerson) {
    const auto run = store_.add_run(booking_);
    advance(run.id, RunEvent::prepared, kNoon + 1, "held");
    ASSERT_TRUE(
        store_->runs.advance(run.id, {RunEvent::release_commanded, kNoon + 2, "go", ada_.id})
    );
    advance(run.id, RunEvent::released, kNoon + 3);
    const auto aborted =
        store_->runs.advance(run.id, {RunEvent::abort, kNoon + 4, "enough", ada_.id});
    ASSERT_TRUE(aborted);
    EXPECT_EQ(aborted->reason, "enough");
    EXPECT_EQ(aborted->started, kNoon + 3);
    EXPECT_EQ(aborted->ended, kNoon + 4);

    const auto history = store_->runs.history(run.id);
    ASSERT_EQ(history.size(), 5U);
    EXPECT_EQ(history[0].state, RunState::preparing);
    EXPECT_EQ(history[0].person, ada_.id);
    EXPECT_EQ(history[1].cause, "held");
    EXPECT_FALSE(history[1].person);
    EXPECT_EQ(history[2].at, kNoon + 2);
    EXPECT_EQ(history[4].state, RunState::aborted);
}

TEST_F(RunsTest, WhatDoesNotFitIsRefusedAndChangesNothing) {
    const auto run = store_.add_run(booking_);
    const auto refused =
        store_->runs.advance(run.id, {RunEvent::measured, kNoon + 1, "stop", ada_.id});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::conflict);
    EXPECT_EQ(store_->runs.find(run.id)->state, RunState::preparing);
    EXPECT_EQ(store_->runs.history(run.id).size(), 1U);
    EXPECT_EQ(
        store_->runs.advance(99, {RunEvent::abort, kNoon, "", {}}).error().code,
        ErrorCode::not_found
    );
}

TEST_F(RunsTest, ARigDoesOneAtATime) {
    const auto run = store_.add_run(booking_);
    EXPECT_EQ(
        store_->runs.add(TemporaryStore::run_for(booking_)).error().code, ErrorCode::conflict
    );
    advance(run.id, RunEvent::fail, kNoon + 1, "broken");
    EXPECT_TRUE(store_->runs.add(TemporaryStore::run_for(booking_)));
}

TEST_F(RunsTest, AreListedNewestFirstInPages) {
    const auto bob = store_.add_user("bob");
    const auto of_bob = store_.add_booking(bob, kNoon, kNoon + 30 * kMinute, "rig-2");
    std::vector<lab::RunId> ids;
    for (int i = 0; i < 6; ++i) {
        ids.push_back(store_.add_run(i % 2 == 0 ? booking_ : of_bob).id);
        advance(ids.back(), RunEvent::abort, kNoon + i);
    }
    const auto page = store_->runs.list({.limit = 4});
    ASSERT_EQ(page.size(), 4U);
    EXPECT_EQ(page.front().id, ids[5]);
    const auto rest = store_->runs.list({.before = page.back().id, .limit = 4});
    ASSERT_EQ(rest.size(), 2U);
    EXPECT_EQ(rest.back().id, ids[0]);
    EXPECT_EQ(store_->runs.list({.user = bob.id}).size(), 3U);
    EXPECT_EQ(store_->runs.list({.user = bob.id, .rig = "rig-1"}).size(), 0U);
}

TEST_F(RunsTest, WhatACrashLeftOpenIsInterruptedAndKeepsItsPoses) {
    const auto over = store_.add_run(booking_);
    advance(over.id, RunEvent::abort, kNoon + 1, "enough");
    const auto open = store_.add_run(booking_);
    MotionSample sample;
    sample.t = kNoon;
    store_->poses.append(open.id, std::vector<StoredPose>{{"bob", sample}});

    const auto other = store_.open();  // as after a restart
    EXPECT_TRUE(other->runs.interrupt_unfinished(kNoon + 2, "power cut", "rig-2").empty());
    EXPECT_EQ(
        other->runs.interrupt_unfinished(kNoon + 2, "power cut"), std::vector<lab::RunId>{open.id}
    );
    EXPECT_EQ(other->runs.find(open.id)->state, RunState::interrupted);
    EXPECT_EQ(other->runs.find(open.id)->reason, "power cut");
    EXPECT_EQ(other->runs.find(over.id)->reason, "enough");
    EXPECT_EQ(other->poses.count(open.id), 1U);
}

TEST_F(RunsTest, ShowTheNewestResult) {
    const auto run = store_.add_run(booking_);
    EXPECT_EQ(store_->results.add({run.id, 0, kNoon, R"({"n":1})", "{}", "[]", {"short"}}), 1);
    EXPECT_EQ(store_->results.add({run.id, 0, kNoon, R"({"n":2})", "{}", "[]", {}}), 2);
    EXPECT_EQ(store_->runs.find(run.id)->result_json, R"({"n":2})");
    EXPECT_EQ(store_->results.latest(run.id)->version, 2);
    EXPECT_FALSE(store_->results.latest(run.id + 1));
    EXPECT_EQ(store_->runs.list({}).size(), 1U);  // versions do not multiply runs
    EXPECT_ANY_THROW(store_->results.add({run.id, 0, kNoon, "no json", "{}", "[]", {}}));
}

MotionSample full_sample() {
    MotionSample s;
    s.t = kNoon + 33'333'333;
    s.status = TrackStatus::interpolated;
    s.has_orientation = true;
    s.p_lab = {0.1, -0.2, 0.3};
    s.q_lab_obj = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
    s.covariance.topLeftCorner<3, 3>() << 4e-6, 1e-7, 2e-7, 1e-7, 9e-6, 3e-7, 2e-7, 3e-7, 1e-6;
    s.v_lab = {1, 2, 3};
    s.w_lab = {4, 5, 6};
    s.quality = {.points = 321, .inlier_share = 0.9, .rms_steps = 0.6};
    return s;
}

TEST_F(RunsTest, PosesComeBackAsTheyWere) {
    const auto run = store_.add_run(booking_);
    const MotionSample s = full_sample();
    MotionSample lost;
    lost.t = s.t + 1;
    lost.status = TrackStatus::lost;
    lost.p_lab.setConstant(std::nan(""));
    store_->poses.append(run.id, std::vector<StoredPose>{{"bob", s}, {"bob", lost}});

    const auto read = store_->poses.of_run(run.id);
    ASSERT_EQ(read.size(), 1U);
    ASSERT_EQ(read[0].samples.size(), 2U);
    const MotionSample& r = read[0].samples[0];
    EXPECT_EQ(r.t, s.t);
    EXPECT_EQ(r.status, s.status);
    EXPECT_EQ(r.has_orientation, s.has_orientation);
    EXPECT_EQ(r.p_lab, s.p_lab);
    EXPECT_EQ(r.q_lab_obj.coeffs(), s.q_lab_obj.coeffs());
    EXPECT_TRUE((r.covariance.topLeftCorner<3, 3>()).isApprox(s.covariance.topLeftCorner<3, 3>()));
    EXPECT_EQ(r.v_lab, s.v_lab);
    EXPECT_EQ(r.w_lab, s.w_lab);
    EXPECT_EQ(r.quality.points, 321);
    EXPECT_EQ(r.quality.inlier_share, 0.9);
    EXPECT_EQ(r.quality.rms_steps, 0.6);
    EXPECT_EQ(read[0].samples[1].status, TrackStatus::lost);
    EXPECT_TRUE(read[0].samples[1].p_lab.array().isNaN().all());
}

TEST_F(RunsTest, FinalTrajectoriesTakeThePlaceOfLivePoses) {
    const auto run = store_.add_run(booking_);
    MotionSample s = full_sample();
    store_->poses.append(run.id, std::vector<StoredPose>{{"bob", s}, {"cube", s}});
    s.v_lab.x() = 7.0;
    store_->poses.replace(run.id, std::vector<Trajectory>{{"bob", {s}}});
    const auto read = store_->poses.of_run(run.id);
    ASSERT_EQ(read.size(), 1U);
    EXPECT_EQ(read[0].samples.at(0).v_lab.x(), 7.0);
    EXPECT_ANY_THROW(store_->poses.append(run.id + 1, std::vector<StoredPose>{{"bob", s}}));
}

}  // namespace
}  // namespace kinectlab::store
