#include "pipeline/track/surface_patch.hpp"

#include <gtest/gtest.h>

#include "pipeline/track/patch_recognition.hpp"
#include "tests/unit/pipeline/support/mesh_room.hpp"

namespace kinectlab {
namespace {

using test::MeshRoom;
using test::Thing;

ObjectSpec spec_of(const TriangleMesh& mesh, const std::string& name = "thing", double unit = 1.0) {
    SurfacePatchSettings settings;
    settings.model = name + ".ply";
    settings.model_unit_m = unit;
    settings.mesh = std::make_shared<const TriangleMesh>(mesh);
    return {name, settings};
}

std::unique_ptr<Tracker> tracker_of(const MeshRoom& room, std::vector<ObjectSpec> specs) {
    auto trackers = make_trackers(room.camera, specs);
    EXPECT_TRUE(trackers.has_value()) << (trackers ? "" : to_text(trackers.error()));
    return std::move(trackers->front());
}

std::vector<TrackSample> track(Tracker& tracker, const RgbdFrame& frame) {
    std::vector<TrackSample> samples;
    tracker.track(frame, {}, samples);
    return samples;
}

/// An angle that no turn of itself repeats, given off its own centre.
TriangleMesh angle_iron() {
    return test::joined(
        test::box_mesh(0.24, 0.06, 0.08), test::box_mesh(0.06, 0.10, 0.08), {0.09, 0.08, 0.0}
    );
}

Eigen::Isometry3d pose(double x, double turn) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(x, 0.0, 1.0);
    T.linear() = (Eigen::AngleAxisd(0.5 + turn, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
    return T;
}

double turn_between(const TrackSample& sample, const Eigen::Isometry3d& T) {
    return sample.q_cam_obj.angularDistance(Eigen::Quaterniond(T.linear()));
}

TEST(SurfacePatchTracker, RecognisesFollowsLosesAndFindsAgain) {
    MeshRoom room(8);
    room.floor_m = 0.35;
    const auto mesh = angle_iron();
    const auto tracker = tracker_of(room, {spec_of(mesh)});
    for (int i = 0; i < 20; ++i) {
        const bool hidden = i >= 8 && i < 10;
        const double jump = i >= 10 ? 0.25 : 0.0;  // taken away and put down elsewhere
        const Eigen::Isometry3d T = pose(-0.15 + 0.01 * i + jump, 0.04 * i);
        std::vector<Thing> things;
        if (!hidden) things.push_back({mesh, T});
        const auto samples = track(*tracker, room.frame(things));
        ASSERT_EQ(samples.size(), 1U);
        ASSERT_EQ(samples[0].status, hidden ? TrackStatus::lost : TrackStatus::tracked) << i;
        if (hidden) continue;
        EXPECT_LT((samples[0].p_cam - T.translation()).norm(), 0.003) << i;
        ASSERT_TRUE(samples[0].has_orientation);
        EXPECT_LT(turn_between(samples[0], T), 0.02) << i;
        const auto& u = samples[0].covariance;
        EXPECT_GT(u.diagonal().minCoeff(), 0.0);
        EXPECT_LT(std::sqrt(u.topLeftCorner<3, 3>().trace()), 0.003);
    }
}

/// The pixels of a picture that differ from those of the room without the thing.
std::vector<std::uint32_t> pixels_of(const RgbdFrame& frame, const RgbdFrame& empty) {
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t i = 0; i < frame.depth.size(); ++i)
        if (frame.depth[i] + 60 < empty.depth[i]) pixels.push_back(i);
    return pixels;
}

TEST(SurfacePatchTracker, AFlatFaceSquareToTheCameraIsKnownByWhatMoved) {
    MeshRoom room(13);
    const auto mesh = test::box_mesh(0.16, 0.10, 0.12);
    const auto tracker = tracker_of(room, {spec_of(mesh)});
    const auto empty = room.frame({});
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(0.0, 0.0, 1.8);
    for (int i = 0; i < 5; ++i) {
        T.translation().x() = -0.2 + 0.1 * i;  // further than it is followed
        const auto frame = room.frame({{mesh, T}});
        const auto pixels = pixels_of(frame, empty);
        const std::array<MovedPixels, 1> moved{pixels};
        std::vector<TrackSample> samples;
        tracker->track(frame, moved, samples);
        ASSERT_EQ(samples[0].status, TrackStatus::tracked) << i;
        EXPECT_LT((samples[0].p_cam - T.translation()).norm(), 0.004) << i;
    }
}

TEST(PatchRecogniser, WhatReachesThePicturesBorderIsNotTakenForAWhole) {
    MeshRoom room(14);
    const auto mesh = test::box_mesh(0.16, 0.10, 0.12);
    const auto model = make_object_model(mesh);
    ASSERT_TRUE(model.has_value());
    PatchRecogniser recogniser(room.camera, std::make_shared<const ObjectModel>(*model));
    const auto empty = room.frame({});
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (const auto& [x, is_found] : {std::pair{-0.6, true}, std::pair{-0.96, false}}) {
        T.translation() = Eigen::Vector3d(x, 0.0, 1.8);
        const auto frame = room.frame({{mesh, T}});
        const auto pixels = pixels_of(frame, empty);
        const std::array<MovedPixels, 1> moved{pixels};
        EXPECT_EQ(recogniser.find_moved(frame.depth, moved).has_value(), is_found) << x;
    }
}

TEST(SurfacePatchTracker, ReportsTheModelsOwnFrameInItsOwnUnit) {
    MeshRoom room(9);
    const auto mesh = angle_iron();
    auto millimetres = mesh;
    const Eigen::Vector3f away(500.0F, -200.0F, 300.0F);  // the file's origin is far from the thing
    for (auto& vertex : millimetres.vertices)
        vertex = 1000.0F * vertex + away;
    const auto tracker = tracker_of(room, {spec_of(millimetres, "thing", 0.001)});
    const Eigen::Isometry3d T = pose(0.0, 0.2);
    const auto samples = track(*tracker, room.frame({{mesh, T}}));
    ASSERT_EQ(samples[0].status, TrackStatus::tracked);
    const Eigen::Vector3d origin = T * Eigen::Vector3d(-0.001 * away.cast<double>());
    const double u = std::sqrt(samples[0].covariance.topLeftCorner<3, 3>().trace());
    EXPECT_LT((samples[0].p_cam - origin).norm(), 0.01);  // an arm of 0.6 m turns with the thing
    EXPECT_LT((samples[0].p_cam - origin).norm(), 5.0 * u);
}

TEST(SurfacePatchTracker, TwoOfAKindAreTwo) {
    MeshRoom room(10);
    const auto mesh = angle_iron();
    const auto tracker = tracker_of(room, {spec_of(mesh, "a"), spec_of(mesh, "b")});
    const Eigen::Isometry3d left = pose(-0.25, 0.0), right = pose(0.25, 0.3);
    const auto samples = track(*tracker, room.frame({{mesh, left}, {mesh, right}}));
    ASSERT_EQ(samples.size(), 2U);
    ASSERT_EQ(samples[0].status, TrackStatus::tracked);
    ASSERT_EQ(samples[1].status, TrackStatus::tracked);
    EXPECT_NEAR(std::abs(samples[0].p_cam.x() - samples[1].p_cam.x()), 0.5, 0.01);
}

TEST(SurfacePatchTracker, WhatIsNotThereIsNotFound) {
    MeshRoom room(11);
    room.floor_m = 0.35;
    const auto tracker = tracker_of(room, {spec_of(angle_iron())});
    Eigen::Isometry3d T = pose(0.1, 0.9);
    const Thing box{test::box_mesh(0.3, 0.2, 0.15), T};
    for (const auto& things : {std::vector<Thing>{}, std::vector<Thing>{box}})
        EXPECT_EQ(track(*tracker, room.frame(things))[0].status, TrackStatus::lost);
    RgbdFrame empty = room.frame({});
    std::fill(empty.depth.begin(), empty.depth.end(), std::uint16_t{0});
    EXPECT_EQ(track(*tracker, empty)[0].status, TrackStatus::lost);
}

TEST(SurfacePatchTracker, ABottlesTurnAboutItsAxisIsNotSeen) {
    MeshRoom room(12);
    const auto bottle = test::turned_mesh(
        {{.001, -.12}, {.045, -.12}, {.045, .03}, {.02, .08}, {.02, .12}, {.001, .12}}, 64
    );
    const auto tracker = tracker_of(room, {spec_of(bottle)});
    const Eigen::Isometry3d T = pose(0.0, 0.0);
    const auto samples = track(*tracker, room.frame({{bottle, T}}));
    ASSERT_EQ(samples[0].status, TrackStatus::tracked);
    EXPECT_FALSE(samples[0].has_orientation);
    EXPECT_LT((samples[0].p_cam - T.translation()).norm(), 0.004);
}

TEST(SurfacePatchTracker, RefusesModelsItCannotUseAndSaysWhy) {
    const RgbdCamera camera;
    const auto error_of = [&](const ObjectSpec& spec) {
        const auto made = make_trackers(camera, std::vector{spec});
        EXPECT_FALSE(made.has_value());
        return made ? std::string() : to_text(made.error());
    };
    EXPECT_NE(
        error_of({"thing", SurfacePatchSettings{}}).find("objects[0].model"), std::string::npos
    );
    EXPECT_NE(
        error_of(spec_of(test::box_mesh(0.1, 0.1, 0.1), "thing", -1.0)).find("model_unit_m"),
        std::string::npos
    );
    EXPECT_NE(error_of(spec_of({{{0, 0, 0}, {1, 1, 1}}, {}})).find("points"), std::string::npos);
    TriangleMesh sheet;
    sheet.vertices = {{0, 0, 0}, {0.2F, 0, 0}, {0, 0.2F, 0}, {0.2F, 0.2F, 0}};
    sheet.triangles = {{0, 1, 2}, {1, 3, 2}};
    EXPECT_NE(error_of(spec_of(sheet)).find("bends"), std::string::npos);
}

}  // namespace
}  // namespace kinectlab
