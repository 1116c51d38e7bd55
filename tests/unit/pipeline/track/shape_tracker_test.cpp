#include "pipeline/track/shape_tracker.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab {
namespace {

using test::ShapeRoom;

constexpr double kKnownAngle = 0.35;

ObjectSpec object(std::string name, MethodSettings settings) {
    return {std::move(name), std::move(settings)};
}

std::vector<TrackSample> track(
    Tracker& tracker, const RgbdFrame& frame, const std::vector<std::vector<std::uint32_t>>& moved
) {
    std::vector<MovedPixels> segments(moved.begin(), moved.end());
    std::vector<TrackSample> samples;
    tracker.track(frame, segments, samples);
    return samples;
}

std::unique_ptr<Tracker> tracker_for(const RgbdCamera& camera, const ObjectSpec& object) {
    auto trackers = make_trackers(camera, std::span(&object, 1));
    EXPECT_TRUE(trackers);
    return std::move(trackers->front());
}

/// A can, a cone, a tilted box and a ball before a wall, far from each other.
ShapeRoom four_things() {
    ShapeRoom room(7);
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    room.solids = {
        test::can({-0.35, 0.1, 1.2}, Eigen::Vector3d(0.2, -1.0, -0.2), 0.045, 0.2),
        test::cone({0.0, -0.15, 1.2}, Eigen::Vector3d(0.1, 1.0, 0.2), kKnownAngle, 0.02, 0.25),
        test::box({0.35, 0.0, 1.3}, turn, {0.12, 0.10, 0.004}),
        test::ball({-0.1, 0.3, 1.2}, 0.06),
        test::wall({0, 0, 2.4}, {0.05, 0, -1})};
    return room;
}

TEST(ShapeTracker, FollowsEachKindAmongWhatMoved) {
    ShapeRoom room = four_things();
    const RgbdFrame frame = room.frame();
    std::vector<std::vector<std::uint32_t>> moved;
    for (int i = 0; i < 4; ++i)
        moved.push_back(room.pixels_of(i));
    const std::vector objects{
        object("can", CylinderSettings{}),
        object("cone", ConeSettings{}),
        object("board", PlaneSettings{}),
        object("ball", SphereSettings{.search = GuessBy::hough})};
    auto trackers = make_trackers(room.camera, objects);
    ASSERT_TRUE(trackers);
    ASSERT_EQ(trackers->size(), 1U);
    const auto samples = track(*trackers->front(), frame, moved);
    ASSERT_EQ(samples.size(), 4U);
    for (const auto& sample : samples)
        EXPECT_EQ(sample.status, TrackStatus::tracked) << objects[sample.object].name;

    const auto& can = room.solids[0];
    const Eigen::Vector3d can_z = samples[0].q_cam_obj * Eigen::Vector3d::UnitZ();
    EXPECT_LT(can_z.cross(can.axis).norm(), 0.02);
    const Eigen::Vector3d middle = can.place + 0.5 * can.to * can.axis;
    EXPECT_LT((samples[0].p_cam - middle).norm(), 0.008);  // its lid hides one end

    const auto& cone = room.solids[1];
    const Eigen::Vector3d cone_z = samples[1].q_cam_obj * Eigen::Vector3d::UnitZ();
    EXPECT_LT((samples[1].p_cam - cone.place).norm(), 0.005);
    EXPECT_GT(cone_z.dot(cone.axis), 0.9995);

    const auto& board = room.solids[2];
    const Eigen::Vector3d board_z = samples[2].q_cam_obj * Eigen::Vector3d::UnitZ();
    EXPECT_GT(std::abs(board_z.dot(board.turn.col(2))), 0.9999);
    EXPECT_LT(board_z.dot(samples[2].p_cam), 0.0);
    EXPECT_LT((samples[2].p_cam - board.place).norm(), 0.01);

    EXPECT_LT((samples[3].p_cam - room.solids[3].place).norm(), 0.003);

    // Each with the size that is its own and no other.
    EXPECT_NEAR(samples[0].size.radius_m, 0.045, 5.0 * samples[0].size.radius_u);
    EXPECT_NEAR(samples[1].size.half_angle_rad, kKnownAngle, 5.0 * samples[1].size.half_angle_u);
    EXPECT_NEAR(samples[3].size.radius_m, 0.06, 5.0 * samples[3].size.radius_u);
    EXPECT_TRUE(std::isnan(samples[0].size.half_angle_rad));
    EXPECT_TRUE(std::isnan(samples[1].size.radius_m));
    EXPECT_TRUE(std::isnan(samples[2].size.radius_m));
}

TEST(ShapeTracker, TakesNoThingForAnother) {
    ShapeRoom room = four_things();
    const RgbdFrame frame = room.frame();
    const std::vector<MethodSettings> methods{CylinderSettings{}, ConeSettings{}, PlaneSettings{}};
    for (std::size_t method = 0; method < methods.size(); ++method) {
        const auto tracker = tracker_for(room.camera, object("x", methods[method]));
        for (int solid = 0; solid < 4; ++solid) {
            const auto samples = track(*tracker, frame, {room.pixels_of(solid)});
            const bool own = solid == static_cast<int>(method);
            const auto expected = own ? TrackStatus::tracked : TrackStatus::lost;
            EXPECT_EQ(samples.at(0).status, expected) << "method " << method << " solid " << solid;
            tracker->reset();
        }
    }
}

TEST(ShapeTracker, AKnownSizeIsKept) {
    ShapeRoom room = four_things();
    const RgbdFrame frame = room.frame();
    const auto can = tracker_for(room.camera, object("can", CylinderSettings{.radius_m = 0.045}));
    const auto known = track(*can, frame, {room.pixels_of(0)}).at(0);
    EXPECT_EQ(known.status, TrackStatus::tracked);
    EXPECT_TRUE(std::isnan(known.size.radius_m)) << "what was given is no measurement";
    const auto cone =
        tracker_for(room.camera, object("cone", ConeSettings{.half_angle_rad = kKnownAngle}));
    const auto sample = track(*cone, frame, {room.pixels_of(1)}).at(0);
    ASSERT_EQ(sample.status, TrackStatus::tracked);
    EXPECT_LT((sample.p_cam - room.solids[1].place).norm(), 0.003);
}

TEST(ShapeTracker, FindsThemInASceneWhereNothingMoved) {
    ShapeRoom room = four_things();
    const RgbdFrame frame = room.frame();
    const std::vector objects{
        object("wall", PlaneSettings{.in = LookIn::scene}),
        object("can", CylinderSettings{.in = LookIn::scene}),
        object("cone", ConeSettings{.in = LookIn::scene}),
        object("ball", SphereSettings{.in = LookIn::scene}),
        object("wall by votes", PlaneSettings{LookIn::scene, GuessBy::hough})};
    auto trackers = make_trackers(room.camera, objects);
    ASSERT_TRUE(trackers);
    const auto samples = track(*trackers->front(), frame, {});
    ASSERT_EQ(samples.size(), objects.size());
    for (const auto& sample : samples)
        ASSERT_EQ(sample.status, TrackStatus::tracked) << objects[sample.object].name;
    for (const std::size_t i : {0U, 4U}) {
        const Eigen::Vector3d z = samples[i].q_cam_obj * Eigen::Vector3d::UnitZ();
        EXPECT_GT(z.dot(room.solids[4].axis), 0.99999);
    }
    const Eigen::Vector3d can_z = samples[1].q_cam_obj * Eigen::Vector3d::UnitZ();
    EXPECT_LT(can_z.cross(room.solids[0].axis).norm(), 0.02);
    EXPECT_LT((samples[2].p_cam - room.solids[1].place).norm(), 0.005);
    EXPECT_LT((samples[3].p_cam - room.solids[3].place).norm(), 0.003);
    EXPECT_FALSE(samples[3].has_orientation);
}

TEST(ShapeTracker, TwoCansKeepTheirNames) {
    ShapeRoom room(8);
    room.solids = {
        test::can({-0.2, 0.1, 1.2}, {0, -1, -0.1}, 0.04, 0.2),
        test::can({0.2, 0.1, 1.2}, {0, -1, -0.1}, 0.04, 0.2),
        test::wall({0, 0, 2.4}, {0, 0, -1})};
    const std::vector objects{
        object("left", CylinderSettings{}), object("right", CylinderSettings{})};
    auto trackers = make_trackers(room.camera, objects);
    ASSERT_TRUE(trackers);
    for (int i = 0; i < 6; ++i) {
        room.solids[0].place.x() = -0.2 + 0.01 * i;
        room.solids[1].place.x() = 0.2 - 0.01 * i;
        room.changed();
        const RgbdFrame frame = room.frame();
        // Whichever is the bigger one comes first.
        const auto samples =
            track(*trackers->front(), frame, {room.pixels_of(i % 2), room.pixels_of(1 - i % 2)});
        if (i == 0) continue;
        ASSERT_EQ(samples.size(), 2U);
        const double first = samples[0].p_cam.x(), second = samples[1].p_cam.x();
        EXPECT_LT(first, second) << i;
    }
}

TEST(ShapeTracker, IsLostWhereThereIsNothing) {
    RgbdCamera camera;
    RgbdFrame frame;
    frame.depth.assign(640 * 480, 0);
    const std::vector objects{
        object("a", PlaneSettings{.in = LookIn::scene}),
        object("b", CylinderSettings{.in = LookIn::scene}),
        object("c", ConeSettings{}),
        object("d", SphereSettings{.in = LookIn::scene, .search = GuessBy::hough}),
        object("e", PlaneSettings{LookIn::moved, GuessBy::hough})};
    auto trackers = make_trackers(camera, objects);
    ASSERT_TRUE(trackers);
    const auto lost = [&](const std::vector<std::vector<std::uint32_t>>& moved) {
        for (const auto& sample : track(*trackers->front(), frame, moved))
            EXPECT_EQ(sample.status, TrackStatus::lost) << objects[sample.object].name;
    };
    lost({});
    std::vector<std::uint32_t> line, point{240 * 640 + 320};
    for (std::uint32_t u = 100; u < 500; ++u)
        line.push_back(240 * 640 + u);
    lost({line, point, {}});  // nothing was read there
    for (const auto pixel : line)
        frame.depth[pixel] = 1000;
    lost({line, point});
    frame.depth.front() = 1;
    frame.depth.back() = 65535;
    lost({point});
}

TEST(ShapeTracker, RefusesSettingsThatAreNone) {
    const auto refusal = [](MethodSettings settings) {
        const auto one = object("x", std::move(settings));
        const auto trackers = make_trackers(RgbdCamera{}, std::span(&one, 1));
        EXPECT_FALSE(trackers);
        return trackers ? std::string() : trackers.error().field;
    };
    for (const double radius : {0.0, -0.05, 5.0, std::nan("")})
        EXPECT_EQ(refusal(CylinderSettings{.radius_m = radius}), "objects[0].radius_m");
    EXPECT_EQ(
        refusal(CylinderSettings{.min_radius_m = 0.2, .max_radius_m = 0.1}),
        "objects[0].min_radius_m"
    );
    for (const double angle : {0.0, -0.3, 1.6, std::nan("")})
        EXPECT_EQ(refusal(ConeSettings{.half_angle_rad = angle}), "objects[0].half_angle_deg");
}

}  // namespace
}  // namespace kinectlab
