#include "server/live/viewer.hpp"

#include <gtest/gtest.h>

namespace kinectlab::live {
namespace {

Viewer::Shared text(const std::string& value) {
    return std::make_shared<const std::string>(value);
}

/// Takes everything that goes out now, as "body tail" texts.
std::vector<std::string> drain(Viewer& viewer) {
    std::vector<std::string> out;
    while (const auto message = viewer.next())
        out.push_back(*message->shared + message->tail);
    return out;
}

void push_poses(Viewer& viewer, std::uint64_t from, std::uint64_t to, TimeNs t = 0) {
    for (std::uint64_t seq = from; seq <= to; ++seq)
        viewer.push_pose(text("p" + std::to_string(seq)), seq, t);
}

TEST(Viewer, StatesAndPosesGoInOrderAndPicturesLast) {
    Viewer viewer;
    viewer.push_picture(text("picture"));
    push_poses(viewer, 1, 1);
    viewer.push_state(text("state"), 2);
    push_poses(viewer, 3, 3);
    const std::vector<std::string> expected{
        "p1,\"missed\":0}", "state", "p3,\"missed\":0}", "picture"};
    EXPECT_EQ(drain(viewer), expected);
}

TEST(Viewer, AStateDoesNotWaitForAnAnswerAndNoOlderPoseFollowsIt) {
    Viewer viewer;
    push_poses(viewer, 1, 8);
    drain(viewer);
    push_poses(viewer, 9, 9);
    viewer.push_state(text("state"), 10);
    EXPECT_EQ(drain(viewer), std::vector<std::string>{"state"});
    viewer.acknowledge(10);
    push_poses(viewer, 11, 11);
    EXPECT_EQ(drain(viewer), std::vector<std::string>{"p11,\"missed\":1}"});
}

TEST(Viewer, WithoutAnswersEightPosesGoOutThenTheNewestOneASecond) {
    Viewer viewer;
    push_poses(viewer, 1, 8, 1);
    EXPECT_EQ(drain(viewer).size(), 8U);
    push_poses(viewer, 9, 30, 2);
    EXPECT_TRUE(drain(viewer).empty());
    push_poses(viewer, 31, 31, 1 + Viewer::kTrickle);
    EXPECT_EQ(drain(viewer), std::vector<std::string>{"p31,\"missed\":22}"});
    push_poses(viewer, 32, 32, 2 + Viewer::kTrickle);
    EXPECT_TRUE(drain(viewer).empty());
}

TEST(Viewer, AnAnswerOpensTheWindowForTheNewest) {
    Viewer viewer;
    push_poses(viewer, 1, 8);
    drain(viewer);
    push_poses(viewer, 9, 12);
    viewer.acknowledge(3);
    EXPECT_EQ(drain(viewer), std::vector<std::string>{"p12,\"missed\":3}"});
    EXPECT_EQ(viewer.missed(), 3U);
}

TEST(Viewer, WhoAnswersMissesNothing) {
    Viewer viewer;
    for (std::uint64_t seq = 1; seq <= 1000; ++seq) {
        push_poses(viewer, seq, seq);
        const auto out = drain(viewer);
        ASSERT_EQ(out.size(), 1U);
        ASSERT_TRUE(out[0].ends_with("\"missed\":0}"));
        viewer.acknowledge(seq);
    }
}

TEST(Viewer, OneThatDoesNotReadCostsNoMoreThanItsBounds) {
    Viewer viewer;
    push_poses(viewer, 1, 10'000);
    for (int i = 0; i < 10'000; ++i) {
        viewer.push_picture(text("picture" + std::to_string(i)));
        viewer.push_state(text("state" + std::to_string(i)), 10'001 + i);
    }
    const auto out = drain(viewer);
    EXPECT_EQ(out.size(), Viewer::kWindow + Viewer::kStates);
    EXPECT_EQ(out.back(), "state9999");
    EXPECT_EQ(viewer.missed(), 10'000 - Viewer::kWindow);
}

TEST(Viewer, PicturesWaitWhileTheWindowIsClosed) {
    Viewer viewer;
    push_poses(viewer, 1, 8);
    drain(viewer);
    viewer.push_picture(text("old"));
    viewer.push_picture(text("new"));
    EXPECT_TRUE(drain(viewer).empty());
    viewer.acknowledge(8);
    EXPECT_EQ(drain(viewer), std::vector<std::string>{"new"});
}

TEST(Viewer, WakesUntilItIsToldNotTo) {
    Viewer viewer;
    int woken = 0;
    viewer.on_wake([&] { ++woken; });
    push_poses(viewer, 1, 2);
    viewer.push_picture(text("picture"));
    EXPECT_EQ(woken, 3);
    viewer.on_wake({});
    push_poses(viewer, 3, 3);
    EXPECT_EQ(woken, 3);
}

}  // namespace
}  // namespace kinectlab::live
