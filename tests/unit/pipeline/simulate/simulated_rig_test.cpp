#include "pipeline/simulate/simulated_rig.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "pipeline/simulate/simulate_run.hpp"

namespace kinectlab::simulate {
namespace {

SimulatedRig rig_with(NoiseModel noise, bool with_colour, double tilt_rad = 0.0) {
    RigSettings settings;
    settings.noise = noise;
    settings.with_colour = with_colour;
    settings.camera.tilt_rad = tilt_rad;
    settings.start = 1'700'000'000 * kNsPerSecond;
    auto rig = SimulatedRig::create(settings);
    EXPECT_TRUE(rig);
    return std::move(*rig);
}

TEST(SimulatedRig, BobLiesWhereTheTruthSays) {
    for (const double tilt : {0.0, 0.1}) {
        SimulatedRig rig = rig_with(NoiseModel::none, false, tilt);
        ASSERT_TRUE(rig.apply({Action::displace, 0.35}));
        rig.advance_to(3.0);
        ASSERT_TRUE(rig.apply({Action::release, 0.0}));
        rig.advance_to(3.7);
        RgbdFrame frame;
        rig.render(frame);
        const Eigen::Vector3d centre_cam = rig.T_lab_cam().inverse() * rig.truth().body().p_lab;
        const Pinhole& camera = rig.camera().depth;
        const Eigen::Vector2d uv = camera.project(centre_cam);
        for (const int du : {-8, 0, 8}) {
            const int u = static_cast<int>(std::lround(uv.x())) + du;
            const int v = static_cast<int>(std::lround(uv.y())) + 5;
            const double z = 1e-3 * frame.depth[static_cast<std::size_t>(v) * camera.width + u];
            EXPECT_NEAR((z * camera.ray(u, v) - centre_cam).norm(), 0.05, 6e-4) << tilt;
        }
    }
}

TEST(SimulatedRig, LabFrameIsRightHandedWithZUp) {
    const Eigen::Isometry3d T_lab_cam = T_lab_cam_of({1.6, 1.15, 0.0});
    EXPECT_NEAR(T_lab_cam.linear().determinant(), 1.0, 1e-12);
    EXPECT_TRUE((T_lab_cam * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(0, -0.6, 1.15)));
    EXPECT_GT((T_lab_cam * Eigen::Vector3d(1, 0, 1)).x(), 0.9);
    const Eigen::Isometry3d tilted = T_lab_cam_of({1.6, 1.15, 0.1});
    EXPECT_LT((tilted * Eigen::Vector3d(0, 0, 1)).z(), 1.15);
}

TEST(SimulatedRig, ColourCameraStandsBesideTheDepthCamera) {
    SimulatedRig rig = rig_with(NoiseModel::kinect, true);
    RgbdFrame frame;
    rig.render(frame);
    double u_sum = 0.0, v_sum = 0.0;
    int red = 0;
    for (int i = 0; i < 640 * 480; ++i) {
        const std::uint8_t* rgb = &frame.rgb[static_cast<std::size_t>(i) * 3];
        if (rgb[0] < 100 || rgb[0] < 2 * rgb[1] || rgb[0] < 2 * rgb[2]) continue;
        u_sum += i % 640;
        v_sum += i / 640;
        ++red;
    }
    ASSERT_GT(red, 500);
    const RgbdCamera& camera = rig.camera();
    const Eigen::Vector3d centre_cam = rig.T_lab_cam().inverse() * rig.truth().body().p_lab;
    const Eigen::Vector2d expected = camera.colour.project(camera.T_colour_depth * centre_cam);
    EXPECT_NEAR(u_sum / red, expected.x(), 1.0);
    EXPECT_NEAR(v_sum / red, expected.y(), 1.5);
    EXPECT_GT((expected - camera.depth.project(centre_cam)).norm(), 5.0);
    EXPECT_EQ(frame.t, 1'700'000'000 * kNsPerSecond);
    EXPECT_EQ(frame.t_colour, frame.t);
}

TEST(SimulatedRig, StaysInViewAtThePromisedAmplitudes) {
    for (const auto& [length, degrees] : {std::pair{1.0, 30.0}, {1.5, 20.0}, {1.0, -30.0}}) {
        const double angle = degrees * 3.14159265358979 / 180.0;
        const Eigen::Vector3d p_lab =
            pivot_of(length) + length * Eigen::Vector3d(std::sin(angle), 0.0, -std::cos(angle));
        const RgbdCamera camera = kinect_camera();
        const Eigen::Vector3d p_cam = T_lab_cam_of({}).inverse() * p_lab;
        const Eigen::Vector2d depth = camera.depth.project(p_cam);
        const Eigen::Vector2d colour = camera.colour.project(camera.T_colour_depth * p_cam);
        for (const Eigen::Vector2d& uv : {depth, colour}) {
            EXPECT_GT(uv.x(), 45.0);
            EXPECT_LT(uv.x(), 595.0);
            EXPECT_GT(uv.y(), 45.0);
            EXPECT_LT(uv.y(), 435.0);
        }
    }
}

TEST(SimulateRun, RestsDisplacesHoldsReleases) {
    RunSettings settings;
    settings.rig.with_colour = false;
    settings.rig.start = 5 * kNsPerSecond;
    settings.seconds = 1.0;
    settings.rest_s = 0.5;
    std::vector<Truth> truths;
    TimeNs last = 0;
    const auto summary = simulate_run(settings, [&](const RgbdFrame& frame, const Truth& truth) {
        EXPECT_EQ(frame.index, truths.size());
        EXPECT_GT(frame.t, last);
        last = frame.t;
        truths.push_back(truth);
        return Result<void>();
    });
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->frames, truths.size());
    EXPECT_EQ(truths.size() - summary->first_free, 30U);
    EXPECT_EQ(truths.front().motion, Motion::at_rest);
    EXPECT_EQ(truths[summary->first_free - 1].motion, Motion::held);
    EXPECT_NEAR(truths[summary->first_free - 1].value, std::numbers::pi / 18.0, 1e-12);
    EXPECT_EQ(truths[summary->first_free].motion, Motion::free);
    EXPECT_NEAR(to_seconds(last), 5.0 + static_cast<double>(truths.size() - 1) / 30.0, 1e-8);
}

TEST(SimulateRun, RefusesWhatMakesNoSense) {
    const auto sink = [](const RgbdFrame&, const Truth&) {
        return Result<void>();
    };
    const auto field_of = [&sink](const RunSettings& settings) {
        const auto summary = simulate_run(settings, sink);
        return summary ? std::string() : summary.error().field;
    };
    RunSettings settings;
    settings.displacement = 2.0;
    EXPECT_EQ(field_of(settings), "angle_rad");
    settings = {};
    settings.seconds = -1.0;
    EXPECT_EQ(field_of(settings), "seconds");
    settings = {};
    settings.rig.apparatus.parameters["bob_radius_m"] = 0.9;
    EXPECT_EQ(field_of(settings), "bob_radius_m");
    settings = {};
    settings.rig.camera.distance_m = 0.0;
    EXPECT_EQ(field_of(settings), "camera");
}

TEST(SimulateRun, HandsOnTheSinksError) {
    RunSettings settings;
    settings.rig.with_colour = false;
    const auto summary = simulate_run(settings, [](const RgbdFrame&, const Truth&) {
        return Result<void>(fail(ErrorCode::unavailable, "out", "disk is full"));
    });
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().field, "out");
}

}  // namespace
}  // namespace kinectlab::simulate
