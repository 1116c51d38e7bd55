#include <gtest/gtest.h>

#include "pipeline/track/tracker.hpp"
#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab {
namespace {

using test::ShapeRoom;
using Segments = std::vector<std::vector<std::uint32_t>>;

/// One tracker for objects of one method, and the room that it looks at.
class ShapeIdentity : public testing::Test {
protected:
    void follow(const std::vector<ObjectSpec>& objects) {
        auto trackers = make_trackers(room.camera, objects);
        ASSERT_TRUE(trackers);
        ASSERT_EQ(trackers->size(), 1U);
        tracker = std::move(trackers->front());
    }

    /// What the next frame shows of the objects; what moved is named by the solids.
    std::vector<TrackSample> next(const std::vector<int>& moved = {}) {
        room.changed();
        const RgbdFrame frame = room.frame();
        Segments pixels;
        for (const int solid : moved)
            pixels.push_back(room.pixels_of(solid));
        const std::vector<MovedPixels> segments(pixels.begin(), pixels.end());
        std::vector<TrackSample> samples;
        tracker->track(frame, segments, samples);
        return samples;
    }

    ShapeRoom room{5};
    std::unique_ptr<Tracker> tracker;
};

TEST_F(ShapeIdentity, TwoObjectsByVotesAreTwoBalls) {
    room.solids = {
        test::ball({-0.3, 0, 1.1}, 0.09),
        test::ball({0.3, 0, 1.1}, 0.06),
        test::wall({0, 0, 2.2}, {0.2, 0, -1})};
    const SphereSettings by_votes{.in = LookIn::scene, .search = GuessBy::hough};
    follow({{"a", by_votes}, {"b", by_votes}});
    std::vector<TrackSample> first;
    for (int i = 0; i < 2; ++i) {
        const auto samples = next();
        ASSERT_EQ(samples[0].status, TrackStatus::tracked) << i;
        ASSERT_EQ(samples[1].status, TrackStatus::tracked) << i;
        if (i == 0) first = samples;
        EXPECT_GT((samples[0].p_cam - samples[1].p_cam).norm(), 0.5);
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_LT((samples[k].p_cam - first[k].p_cam).norm(), 0.01) << "a name changed";
    }
}

TEST_F(ShapeIdentity, TwoObjectsByVotesAreTwoPlanes) {
    room.solids = {test::wall({0, 0.5, 0}, {0, -1, -0.2}), test::wall({0, 0, 2.2}, {0.1, 0, -1})};
    const PlaneSettings by_votes{LookIn::scene, GuessBy::hough};
    follow({{"a", by_votes}, {"b", by_votes}});
    const auto samples = next();
    ASSERT_EQ(samples[0].status, TrackStatus::tracked);
    ASSERT_EQ(samples[1].status, TrackStatus::tracked);
    const Eigen::Vector3d z_a = samples[0].q_cam_obj * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d z_b = samples[1].q_cam_obj * Eigen::Vector3d::UnitZ();
    EXPECT_LT(std::abs(z_a.dot(z_b)), 0.5);
}

TEST_F(ShapeIdentity, ACanThatIsTakenAwayIsLost) {
    const test::Solid mine = test::can({-0.05, 0.1, 1.0}, {0, -1, -0.1}, 0.05, 0.22);
    const test::Solid other = test::can({0.1, 0.1, 1.05}, {0, -1, -0.1}, 0.03, 0.15);
    const test::Solid wall = test::wall({0, 0, 2.2}, {0.1, 0, -1});
    for (const LookIn in : {LookIn::scene, LookIn::moved}) {
        room = ShapeRoom(5);
        room.solids = {mine, other, wall};
        follow({{"can", CylinderSettings{.in = in}}});
        for (int i = 0; i < 3; ++i) {
            const auto samples = next({0, 1});
            ASSERT_EQ(samples[0].status, TrackStatus::tracked);
            ASSERT_NEAR(samples[0].size.radius_m, 0.05, 0.005);
        }
        room.solids = {other, wall};
        EXPECT_EQ(next({0})[0].status, TrackStatus::lost);
        room.solids = {mine, wall};
        EXPECT_EQ(next({0})[0].status, TrackStatus::tracked) << "it is back";
        tracker->reset();
        room.solids = {other, wall};
        EXPECT_EQ(next({0})[0].status, TrackStatus::tracked) << "forgotten";
    }
}

TEST_F(ShapeIdentity, AHiddenBallIsLostAndNotAnotherOne) {
    const test::Solid mine = test::ball({-0.4, 0, 1.3}, 0.05);
    const test::Solid wall = test::wall({0, 0, 2.2}, {0.1, 0, -1});
    for (const double radius : {0.05, 0.035}) {
        room = ShapeRoom(5);
        const test::Solid other = test::ball({0.3, 0, 1.3}, radius);
        room.solids = {mine, other, wall};
        follow({{"ball", SphereSettings{}}});
        for (int i = 0; i < 4; ++i) {
            ASSERT_EQ(
                next(i == 0 ? std::vector{0} : std::vector{0, 1})[0].status, TrackStatus::tracked
            );
        }
        room.solids = {other, wall};
        EXPECT_EQ(next({0})[0].status, TrackStatus::lost) << radius;
        for (int i = 0; i < 31; ++i)
            (void)room.frame();  // a second goes by
        const bool same = radius == 0.05;
        EXPECT_EQ(next({0})[0].status, same ? TrackStatus::tracked : TrackStatus::lost) << radius;
    }
}

TEST_F(ShapeIdentity, AThrownBallIsFollowed) {
    const test::Solid wall = test::wall({0, 0, 2.6}, {0.1, 0, -1});
    for (int i = 0; i < 5; ++i) {
        const double t = i / 30.0;
        room.solids = {test::ball({-0.6 + 7.8 * t, -0.2 + 1.8 * t, 1.8}, 0.05), wall};
        if (i == 0) follow({{"ball", SphereSettings{}}});
        EXPECT_EQ(next({0})[0].status, TrackStatus::tracked) << i;
    }
}

/// However a box is turned, and as far away as a cone fits its corner within the noise, it is
/// neither a cone nor a can.
TEST_F(ShapeIdentity, ABoxThatTumblesIsNothingRound) {
    const Eigen::Vector3d axis = Eigen::Vector3d(0.5, 0.7, 0.4).normalized();
    int cones = 0, cans = 0;
    for (int i = 0; i < 24; ++i) {
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.26 * i, axis).toRotationMatrix();
        room.solids = {
            test::box({0, 0, 1.7}, turn, {0.05, 0.05, 0.05}),
            test::wall({0, 0, 2.4}, {0.05, 0, -1})};
        follow({{"cone", ConeSettings{}}, {"can", CylinderSettings{}}});
        room.changed();
        const RgbdFrame frame = room.frame();
        const auto pixels = room.pixels_of(0);
        const std::vector<MovedPixels> segments{pixels, pixels};  // one for each object
        std::vector<TrackSample> samples;
        tracker->track(frame, segments, samples);
        cones += samples[0].status == TrackStatus::tracked ? 1 : 0;
        cans += samples[1].status == TrackStatus::tracked ? 1 : 0;
    }
    EXPECT_EQ(cones, 0);
    EXPECT_LE(cans, 1);
}

}  // namespace
}  // namespace kinectlab
