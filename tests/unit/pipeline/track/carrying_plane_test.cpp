#include "pipeline/track/carrying_plane.hpp"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab {
namespace {

using test::ShapeRoom;
using ::testing::HasSubstr;

constexpr double kRadius = 0.035;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFloor = 0.95;
constexpr int kBall = 0, kPlank = 1;

ObjectSpec ball() {
    return {"ball", SphereSettings{.radius_m = kRadius}};
}
ObjectSpec plank(const std::string& under = "ball") {
    return {"plank", PlaneSettings{.under = under}};
}

/// A plank that falls to the right, seen flatly from above, before a wall and above a floor that
/// are many times its size; another board goes on in the same plane after a gap.
struct Bench {
    ShapeRoom room{5};
    Eigen::Matrix3d turn;
    Eigen::Vector3d middle{0.0, 0.45, 1.6};
    TimeNs pause = 0;  ///< in which nothing was seen

    explicit Bench(double slope_deg) {
        turn =
            (Eigen::AngleAxisd(slope_deg * kDegree, Eigen::Vector3d::UnitZ())).toRotationMatrix();
        room.solids = {
            test::ball(Eigen::Vector3d::Zero(), kRadius),
            test::box(middle, turn, {0.6, 0.01, 0.15}),
            test::wall({0, 0, 3.2}, {0, 0, -1}),
            test::wall({0, kFloor, 0}, {0, -1, 0}),
            test::box(middle + 0.85 * turn.col(0), turn, {0.15, 0.01, 0.15})};
        put(-0.3);
    }
    [[nodiscard]] Eigen::Vector3d normal() const { return -turn.col(1); }
    /// The ball on the plank, so far down it from its middle.
    void put(double s, double above_m = 0.0) {
        room.solids[kBall].place = middle + turn.col(0) * s + normal() * (0.01 + kRadius + above_m);
        room.changed();
    }
    [[nodiscard]] double turn_off(const TrackSample& sample) const {
        const Eigen::Vector3d z = sample.q_cam_obj * Eigen::Vector3d::UnitZ();
        return z.cross(normal()).norm();
    }
};

/// One frame through the trackers of ball and plank; the sample of the plank.
TrackSample seen(std::vector<std::unique_ptr<Tracker>>& trackers, Bench& bench, bool moved = true) {
    RgbdFrame frame = bench.room.frame();
    frame.t += bench.pause;
    const auto pixels = bench.room.pixels_of(kBall);
    std::vector<MovedPixels> segments;
    if (moved) segments.emplace_back(pixels);
    std::vector<TrackSample> samples;
    for (const auto& tracker : trackers)
        tracker->track(frame, segments, samples);
    EXPECT_EQ(samples.size(), 2U);
    return samples.back();
}

std::vector<std::unique_ptr<Tracker>> trackers_for(const Bench& bench) {
    const std::vector objects{ball(), plank()};
    return std::move(make_trackers(bench.room.camera, objects).value());
}

TEST(CarryingPlane, IsThePlankAndNotTheMuchBiggerWallOrFloor) {
    for (const double slope : {0.0, 3.0, 8.0, 15.0, 25.0}) {
        Bench bench(slope);
        auto trackers = trackers_for(bench);
        const auto sample = seen(trackers, bench);
        ASSERT_EQ(sample.status, TrackStatus::tracked) << slope;
        EXPECT_LT(bench.turn_off(sample), 0.01) << slope;
        // All of it and no other board: the middle of what is seen is the plank's own.
        EXPECT_LT((sample.p_cam - bench.middle).norm(), 0.08) << slope;
    }
}

TEST(CarryingPlane, IsThePlankThoughAWallStandsRightBehindIt) {
    Bench bench(8.0);
    bench.room.solids[2] = test::wall({0, 0, 1.75}, {0, 0, -1});
    bench.room.changed();
    auto trackers = trackers_for(bench);
    const auto sample = seen(trackers, bench);
    ASSERT_EQ(sample.status, TrackStatus::tracked);
    EXPECT_LT(bench.turn_off(sample), 0.01);
}

TEST(CarryingPlane, ItsTurnIsAsSureAsItSays) {
    Bench bench(12.0);
    auto trackers = trackers_for(bench);
    double squares = 0.0;
    constexpr int kFrames = 30;
    for (int i = 0; i < kFrames; ++i) {
        bench.put(-0.45 + 0.03 * i);
        const auto sample = seen(trackers, bench);
        ASSERT_EQ(sample.status, TrackStatus::tracked) << i;
        // About the viewing direction: what makes the slope.
        const Eigen::Vector3d z = sample.q_cam_obj * Eigen::Vector3d::UnitZ();
        // At right angles to z, about which it may be turned anyhow.
        const Eigen::Vector3d axis = z.cross(bench.turn.col(0)).normalized();
        const Eigen::Matrix3d covariance = sample.covariance.bottomRightCorner<3, 3>();
        squares += std::pow(axis.dot(bench.normal().cross(z)), 2) / axis.dot(covariance * axis);
        EXPECT_LT(std::sqrt(axis.dot(covariance * axis)), 0.1 * kDegree);
    }
    EXPECT_GT(squares / kFrames, 0.1);  // neighbours' errors were taken to go together
    EXPECT_LT(squares / kFrames, 2.5);
}

TEST(CarryingPlane, IsFollowedWhileTheBallIsNotSeen) {
    Bench bench(8.0);
    auto trackers = trackers_for(bench);
    ASSERT_EQ(seen(trackers, bench).status, TrackStatus::tracked);
    const auto after = seen(trackers, bench, false);
    EXPECT_EQ(after.status, TrackStatus::tracked);
    EXPECT_LT(bench.turn_off(after), 0.01);
}

TEST(CarryingPlane, IsLostBeforeTheBallTouchesOne) {
    Bench bench(8.0);
    auto trackers = trackers_for(bench);
    const auto none = seen(trackers, bench, false);
    EXPECT_EQ(none.status, TrackStatus::lost);
    EXPECT_FALSE(none.quality.why_lost.empty());
    for (const double above_m : {0.06, 0.018}) {
        bench.put(-0.3, above_m);
        EXPECT_EQ(seen(trackers, bench).status, TrackStatus::lost) << above_m;
    }
    bench.put(-0.3);
    EXPECT_EQ(seen(trackers, bench).status, TrackStatus::tracked);
    trackers.back()->reset();
    EXPECT_EQ(seen(trackers, bench, false).status, TrackStatus::lost);
}

TEST(CarryingPlane, NoPlankNoPlane) {
    Bench bench(8.0);
    bench.room.solids.erase(bench.room.solids.begin() + kPlank);
    bench.room.changed();
    auto trackers = trackers_for(bench);
    EXPECT_EQ(seen(trackers, bench).status, TrackStatus::lost);
}

TEST(CarryingPlane, IsLostWhereItIsGone) {
    Bench bench(8.0);
    auto trackers = trackers_for(bench);
    ASSERT_EQ(seen(trackers, bench).status, TrackStatus::tracked);
    bench.room.solids[kPlank].place.y() += 3.0;
    bench.room.changed();
    const auto gone = seen(trackers, bench, false);
    EXPECT_EQ(gone.status, TrackStatus::lost);
    EXPECT_THAT(std::string(gone.quality.why_lost), HasSubstr("in view"));
}

TEST(CarryingPlane, GoesWithTheBallToAnotherPlane) {
    Bench bench(8.0);
    auto trackers = trackers_for(bench);
    bench.room.solids[kBall].place = {-0.1, kFloor - kRadius, 2.2};  // on the floor first
    bench.room.changed();
    const auto floor = seen(trackers, bench);
    ASSERT_EQ(floor.status, TrackStatus::tracked);
    EXPECT_LT((floor.q_cam_obj * Eigen::Vector3d::UnitZ()).y(), -0.999);
    bench.put(0.0);
    bench.pause = 2 * kNsPerSecond;  // somebody carries it over
    const auto sample = seen(trackers, bench);
    ASSERT_EQ(sample.status, TrackStatus::tracked);
    EXPECT_LT(bench.turn_off(sample), 0.01);
}

TEST(CarryingPlane, RefusesToBeUnderWhatIsNoBall) {
    const auto refusal = [](const std::vector<ObjectSpec>& objects) {
        const auto trackers = make_trackers(RgbdCamera{}, objects);
        EXPECT_FALSE(trackers);
        return trackers ? std::string() : to_text(trackers.error());
    };
    EXPECT_THAT(refusal({ball(), plank("bal")}), HasSubstr("objects[1].under"));
    EXPECT_THAT(refusal({ball(), plank("bal")}), HasSubstr("did you mean ball"));
    EXPECT_THAT(refusal({ball(), plank("plank")}), HasSubstr("no ball"));
    EXPECT_THAT(refusal({plank("ball")}), HasSubstr("method sphere"));
}

}  // namespace
}  // namespace kinectlab
