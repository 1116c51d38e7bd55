#include "server/live/channel.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace kinectlab::live {
namespace {

using nlohmann::json;
constexpr TimeNs kNow = 1'800'000'000 * kNsPerSecond;

const Encoders kEncoders{
    [](const lab::RigStatus& rig) {
        return json{{"id", rig.id}}.dump();
    },
    [](const lab::Run& run) {
        return json{{"id", run.id}}.dump();
    }};

lab::Run run_in(lab::RunState state, lab::RunId id = 3) {
    lab::Run run;
    run.id = id;
    run.state = state;
    return run;
}

bus::PoseMeasured pose_at(TimeNs t, bool in_run = true) {
    bus::PoseMeasured pose;
    pose.rig = "rig-1";
    pose.object = "bob";
    if (in_run) pose.run = 3;
    pose.sample.t = t;
    pose.sample.status = TrackStatus::tracked;
    pose.sample.p_lab = {0.1, -0.2, 0.123456};
    return pose;
}

std::vector<json> received(Viewer& viewer) {
    std::vector<json> messages;
    while (const auto message = viewer.next())
        messages.push_back(json::parse(*message->shared + message->tail));
    return messages;
}

TEST(Channel, ALateViewerGetsThePathWithoutGapOrRepetition) {
    Channel channel;
    channel.rig_changed({.id = "rig-1"}, kEncoders);
    channel.run_changed(run_in(lab::RunState::measuring), kEncoders);
    channel.pose_measured(pose_at(1), kNow);
    channel.pose_measured(pose_at(2), kNow);
    const auto viewer = std::make_shared<Viewer>();
    channel.add(viewer, std::nullopt, kEncoders, kNow);
    channel.pose_measured(pose_at(3), kNow);

    const auto messages = received(*viewer);
    ASSERT_EQ(messages.size(), 2U);
    EXPECT_EQ(messages[0]["type"], "hello");
    EXPECT_EQ(messages[0]["rig"]["id"], "rig-1");
    EXPECT_EQ(messages[0]["run"]["id"], 3);
    EXPECT_EQ(
        messages[0]["trail"],
        json::parse("[[1,0.1,-0.2,0.1235,\"bob\"],[2,0.1,-0.2,0.1235,\"bob\"]]")
    );
    EXPECT_EQ(messages[1]["t_ns"], 3);
    EXPECT_LT(messages[0]["seq"], messages[1]["seq"]);
}

TEST(Channel, TheTrailIsOfTheRunUnderWayOnly) {
    Channel channel;
    channel.pose_measured(pose_at(1, false), kNow);
    channel.run_changed(run_in(lab::RunState::measuring), kEncoders);
    channel.pose_measured(pose_at(2), kNow);
    channel.run_changed(run_in(lab::RunState::completed), kEncoders);
    const auto after = std::make_shared<Viewer>();
    channel.add(after, std::nullopt, kEncoders, kNow);
    const auto hello = received(*after).front();
    EXPECT_TRUE(hello["run"].is_null() && hello["rig"].is_null());
    EXPECT_TRUE(hello["trail"].empty());

    channel.run_changed(run_in(lab::RunState::preparing, 4), kEncoders);
    const auto next = std::make_shared<Viewer>();
    channel.add(next, lab::RigStatus{.id = "rig-1"}, kEncoders, kNow);
    EXPECT_TRUE(received(*next).front()["trail"].empty());
}

TEST(Channel, ALostPoseHasNoNumbers) {
    Channel channel;
    const auto viewer = std::make_shared<Viewer>();
    channel.add(viewer, std::nullopt, kEncoders, kNow);
    auto pose = pose_at(1);
    pose.object = "the \"bob\"";
    pose.sample.status = TrackStatus::lost;
    pose.sample.p_lab.setConstant(std::numeric_limits<double>::quiet_NaN());
    channel.pose_measured(pose, kNow);
    const auto message = received(*viewer).back();
    EXPECT_TRUE(message["p"].is_null());
    EXPECT_EQ(message["status"], "lost");
    EXPECT_EQ(message["object"], "the \"bob\"");
}

TEST(Channel, AllViewersShareOneBuffer) {
    Channel channel;
    const auto a = std::make_shared<Viewer>();
    const auto b = std::make_shared<Viewer>();
    channel.add(a, std::nullopt, kEncoders, kNow);
    channel.add(b, std::nullopt, kEncoders, kNow);
    static_cast<void>(a->next());
    static_cast<void>(b->next());
    channel.pose_measured(pose_at(1), kNow);
    EXPECT_EQ(a->next()->shared.get(), b->next()->shared.get());
    channel.remove(a);
    EXPECT_EQ(channel.viewers(), 1U);
}

}  // namespace
}  // namespace kinectlab::live
