#include "pipeline/track/colour.hpp"

#include <limits>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "pipeline/simulate/pendulum.hpp"
#include "pipeline/simulate/simulate_run.hpp"
#include "tests/unit/pipeline/support/textured_scene.hpp"

namespace kinectlab {
namespace {

using test::PrintedBox;
using test::TexturedScene;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

PrintedBox plain_box(double x, double angle_rad) {
    PrintedBox box;
    box.print = 0;
    box.half_m = {0.05, 0.12, 0.02};
    box.colour = {40.0, 170.0, 60.0};
    box.T_cam_box.translation() << x, 0.02, 1.1;
    box.T_cam_box.linear() =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return box;
}

std::unique_ptr<Tracker> tracker_for(const RgbdCamera& camera, const ColourSettings& settings) {
    const std::vector<ObjectSpec> objects{{"box", settings}};
    auto trackers = make_trackers(camera, objects);
    EXPECT_TRUE(trackers) << (trackers ? "" : to_text(trackers.error()));
    return std::move(trackers->front());
}

TrackSample sample_of(Tracker& tracker, const RgbdFrame& frame) {
    std::vector<TrackSample> samples;
    tracker.track(frame, {}, samples);
    EXPECT_EQ(samples.size(), 1U);
    return samples.front();
}

ColourSettings click_on(const TexturedScene& scene, const PrintedBox& box) {
    const Eigen::Vector2d at =
        scene.camera.colour.project(scene.camera.T_colour_depth * box.T_cam_box.translation());
    ColourSettings settings;
    settings.box = PictureBox{static_cast<int>(at.x()), static_cast<int>(at.y()), 1, 1};
    return settings;
}

TEST(Colour, FollowsPlaceAndTurnFromOneClick) {
    TexturedScene scene(1, 2);
    const PrintedBox first = plain_box(-0.1, 0.0);
    auto tracker = tracker_for(scene.camera, click_on(scene, first));
    const TrackSample before = sample_of(*tracker, scene.frame({first}));
    ASSERT_EQ(before.status, TrackStatus::tracked);
    EXPECT_TRUE(before.q_cam_obj.isApprox(Eigen::Quaterniond::Identity()));

    const TrackSample after = sample_of(*tracker, scene.frame({plain_box(0.05, 0.4)}));
    ASSERT_EQ(after.status, TrackStatus::tracked);
    const Eigen::Vector3d moved = after.p_cam - before.p_cam;
    EXPECT_LT((moved - Eigen::Vector3d(0.15, 0.0, 0.0)).norm(), 0.003) << moved.transpose();
    ASSERT_TRUE(after.has_orientation);
    const Eigen::AngleAxisd turn(after.q_cam_obj);
    const Eigen::Vector3d rotation = turn.angle() * turn.axis();
    EXPECT_LT((rotation - Eigen::Vector3d(0.0, 0.0, 0.4)).norm(), 0.05) << rotation.transpose();
    EXPECT_GT(after.covariance(0, 0), 0.0);
}

TEST(Colour, HoldsWhileBrightnessAndWhiteBalanceWander) {
    TexturedScene scene(1, 2);
    const PrintedBox box = plain_box(0.0, 0.1);
    auto tracker = tracker_for(scene.camera, click_on(scene, box));
    const TrackSample before = sample_of(*tracker, scene.frame({box}));
    for (const std::array<double, 3> gain :
         {std::array<double, 3>{0.6, 0.6, 0.6}, {1.1, 0.85, 0.7}, {0.7, 0.9, 1.1}}) {
        scene.gain = gain;
        const TrackSample now = sample_of(*tracker, scene.frame({box}));
        ASSERT_EQ(now.status, TrackStatus::tracked) << gain[0];
        EXPECT_LT((now.p_cam - before.p_cam).norm(), 0.002) << gain[0];
        EXPECT_GT(now.quality.points, before.quality.points * 9 / 10);
    }
}

TEST(Colour, LearnsFromABoxThatShowsSomeWallToo) {
    TexturedScene scene(1, 2);
    const PrintedBox box = plain_box(0.0, 0.0);
    ColourSettings settings = click_on(scene, box);
    settings.box->left -= 20, settings.box->top -= 35;
    settings.box->width = 40, settings.box->height = 70;
    auto tracker = tracker_for(scene.camera, settings);
    const TrackSample sample = sample_of(*tracker, scene.frame({box}));
    ASSERT_EQ(sample.status, TrackStatus::tracked);
    EXPECT_NEAR(sample.p_cam.z(), 1.08, 0.01);
}

TEST(Colour, KeepsToItsObjectBesideABiggerOneOfTheSameColour) {
    TexturedScene scene(1, 2);
    const PrintedBox first = plain_box(-0.3, 0.0);
    PrintedBox other = plain_box(0.3, 0.0);
    other.half_m *= 1.3;
    auto tracker = tracker_for(scene.camera, click_on(scene, first));
    EXPECT_LT(sample_of(*tracker, scene.frame({first, other})).p_cam.x(), 0.0);
    EXPECT_LT(sample_of(*tracker, scene.frame({plain_box(-0.25, 0.0), other})).p_cam.x(), 0.0);
}

TEST(Colour, IsLostWhereItsColourIsNot) {
    TexturedScene scene(1, 2);
    ColourSettings bounds;
    bounds.bounds = ColourBounds{.hue_min_deg = 340.0, .hue_max_deg = 20.0};
    auto red = tracker_for(scene.camera, bounds);
    const RgbdFrame green = scene.frame({plain_box(0.0, 0.0)});
    EXPECT_EQ(sample_of(*red, green).status, TrackStatus::lost);

    ColourSettings wall;  // grey has no hue
    wall.box = PictureBox{20, 20, 20, 20};
    auto grey = tracker_for(scene.camera, wall);
    EXPECT_EQ(sample_of(*grey, green).status, TrackStatus::lost);

    auto here = tracker_for(scene.camera, click_on(scene, plain_box(0.0, 0.0)));
    EXPECT_EQ(sample_of(*here, green).status, TrackStatus::tracked);
    RgbdFrame blind = green;
    std::fill(blind.depth.begin(), blind.depth.end(), 0);
    EXPECT_EQ(sample_of(*here, blind).status, TrackStatus::lost);
    blind = green;
    blind.rgb.clear();
    EXPECT_EQ(sample_of(*here, blind).status, TrackStatus::lost);
}

/// Centroid of the box's visible surface, without noise.
Eigen::Vector3d true_place(const PrintedBox& box) {
    TexturedScene exact(1);
    exact.sigma_steps = exact.edge_px = exact.colour_noise = 0.0;
    const RgbdFrame frame = exact.frame({box});
    const Pinhole& k = exact.camera.depth;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int points = 0;
    for (int v = 0; v < k.height; ++v)
        for (int u = 0; u < k.width; ++u) {
            const auto reading = frame.depth[static_cast<std::size_t>(v * k.width + u)];
            const double z = exact.camera.depth_unit_m * reading;
            if (z > 0.9 * exact.wall_m) continue;
            sum += k.ray(u, v) * z;
            ++points;
        }
    return sum / points;
}

TEST(Colour, CountsTheSteepSideThatABoxShows) {
    TexturedScene scene(5);
    PrintedBox box = plain_box(-0.1, 0.0);
    box.half_m = {0.06, 0.10, 0.03};
    box.T_cam_box.linear() =
        Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.2, 0.3, 1.0).normalized()).toRotationMatrix();
    auto tracker = tracker_for(scene.camera, click_on(scene, box));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    constexpr int kFrames = 6;
    for (int i = 0; i < kFrames; ++i)
        sum += sample_of(*tracker, scene.frame({box})).p_cam - true_place(box);
    EXPECT_LT((sum / kFrames).norm(), 0.0005) << (sum / kFrames).transpose();
}

/// Mean over frames and seeds of eᵀ Σ⁻¹ e, which is 3 where Σ is what the error e scatters with.
double normalised_error(std::uint32_t print, double motion_m) {
    double sum = 0.0;
    int count = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        TexturedScene scene(seed);
        const auto box_at = [&](int i) {
            PrintedBox box = plain_box(-0.08 + motion_m * i + 0.013 * seed, 0.1 + 0.1 * seed);
            box.print = print;
            return box;
        };
        auto tracker = tracker_for(scene.camera, click_on(scene, box_at(0)));
        for (int i = 0; i < 12; ++i) {
            const TrackSample sample = sample_of(*tracker, scene.frame({box_at(i)}));
            EXPECT_EQ(sample.status, TrackStatus::tracked) << sample.quality.why_lost;
            if (sample.status != TrackStatus::tracked) continue;
            const Eigen::Vector3d off = sample.p_cam - true_place(box_at(i));
            const Eigen::Matrix3d covariance = sample.covariance.topLeftCorner<3, 3>();
            sum += off.dot(covariance.inverse() * off);
            ++count;
            EXPECT_LT(off.norm(), 0.002) << off.transpose();
        }
    }
    return sum / count;
}

TEST(Colour, CovarianceCoversTheErrorAtRest) {
    const double error = normalised_error(0, 0.0);
    EXPECT_GT(error, 0.5);
    EXPECT_LT(error, 6.0);
}

TEST(Colour, CovarianceCoversTheErrorInMotion) {
    const double error = normalised_error(0, 0.007);
    EXPECT_GT(error, 0.5);
    EXPECT_LT(error, 6.0);
}

TEST(Colour, AGreyThingCanBeLearnedWhereItsSurroundingsAreNot) {
    TexturedScene scene(1, 2);
    PrintedBox black = plain_box(0.0, 0.0);
    black.colour = {30.0, 30.0, 30.0};
    auto tracker = tracker_for(scene.camera, click_on(scene, black));
    const TrackSample sample = sample_of(*tracker, scene.frame({black}));
    if (const auto fault = tracker->take_fault()) FAIL() << to_text(*fault);
    ASSERT_EQ(sample.status, TrackStatus::tracked) << sample.quality.why_lost;
    EXPECT_NEAR(sample.p_cam.z(), 1.08, 0.01);
}

/// What the tracker says of a click on a scene, once.
std::string fault_of(TexturedScene& scene, const ColourSettings& settings, const RgbdFrame& frame) {
    auto tracker = tracker_for(scene.camera, settings);
    const TrackSample sample = sample_of(*tracker, frame);
    EXPECT_EQ(sample.status, TrackStatus::lost);
    EXPECT_EQ(sample.quality.why_lost, "its colour could not be learned");
    const auto fault = tracker->take_fault();
    EXPECT_FALSE(tracker->take_fault()) << "told once";
    EXPECT_TRUE(fault && !fault->cure.empty());
    return fault ? fault->field + ": " + fault->message : std::string();
}

TEST(Colour, SaysWhyAClickCannotBeLearned) {
    TexturedScene scene(1, 2);
    const PrintedBox box = plain_box(0.0, 0.0);
    RgbdFrame frame = scene.frame({box});
    ColourSettings wall;
    wall.box = PictureBox{20, 20, 1, 1};
    EXPECT_THAT(
        fault_of(scene, wall, frame),
        testing::HasSubstr("objects[0].click: shows a surface that fills")
    );
    wall.box = PictureBox{20, 20, 40, 40};
    EXPECT_THAT(
        fault_of(scene, wall, frame),
        testing::HasSubstr("objects[0].box: shows nothing but colours")
    );
    const ColourSettings click = click_on(scene, box);
    std::fill(frame.depth.begin(), frame.depth.end(), 0);
    EXPECT_THAT(
        fault_of(scene, click, frame),
        testing::HasSubstr("objects[0].click: lies where the camera reads no depth")
    );
}

TEST(Colour, TheChainRefusesAClickThatCannotBeLearned) {
    TexturedScene scene(1, 2);
    ColourSettings wall;
    wall.box = PictureBox{20, 20, 1, 1};
    auto chain = Chain::create({scene.camera, {{"wall", wall}}});
    ASSERT_TRUE(chain);
    const RgbdFrame frame = scene.frame({});
    ASSERT_TRUE(chain->learn(frame));
    const auto refused = chain->track(frame);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().field, "objects[0].click");
}

TEST(Colour, SaysWhyAThingIsLost) {
    TexturedScene scene(1, 2);
    const PrintedBox box = plain_box(0.0, 0.0);
    ColourSettings settings = click_on(scene, box);
    auto tracker = tracker_for(scene.camera, settings);
    EXPECT_TRUE(sample_of(*tracker, scene.frame({box})).quality.why_lost.empty());
    EXPECT_EQ(
        sample_of(*tracker, scene.frame({})).quality.why_lost,
        "its colour is not seen where it could be"
    );
    settings.learn_at_s = 1.0;
    auto later = tracker_for(scene.camera, settings);
    EXPECT_EQ(
        sample_of(*later, scene.frame({box})).quality.why_lost, "its colour is not learned yet"
    );
}

TEST(Colour, FollowsASimulatedPendulum) {
    simulate::RunSettings run;
    run.seconds = 0.7;
    run.rest_s = run.held_s = 0.1;
    const auto rig = simulate::SimulatedRig::create(run.rig);
    const Eigen::Isometry3d T_cam_lab = rig->T_lab_cam().inverse();
    ColourSettings red;
    red.bounds = ColourBounds{.hue_min_deg = 340.0, .hue_max_deg = 20.0, .saturation_min = 0.5};
    auto tracker = tracker_for(rig->camera(), red);
    int swinging = 0;
    const auto sink = [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
        if (truth.motion != simulate::Motion::free || frame.index % 3 != 0) return {};
        const TrackSample sample = sample_of(*tracker, frame);
        EXPECT_EQ(sample.status, TrackStatus::tracked);
        // A ball shows its front: two thirds of the radius before its centre.
        const Eigen::Vector3d centre_cam = T_cam_lab * truth.body().p_lab;
        const Eigen::Vector3d front_cam =
            centre_cam -
            2.0 / 3.0 * simulate::PendulumParameters().bob_radius_m * centre_cam.normalized();
        EXPECT_LT((sample.p_cam - front_cam).norm(), 0.007) << frame.index;
        EXPECT_FALSE(sample.has_orientation) << "a ball shows none";
        ++swinging;
        return {};
    };
    EXPECT_TRUE(simulate::simulate_run(run, sink));
    EXPECT_GE(swinging, 6);
}

TEST(Colour, RefusesSettingsByName) {
    const auto field = [](const ColourSettings& settings) {
        const std::vector<ObjectSpec> objects{{"box", settings}};
        const auto trackers = make_trackers(RgbdCamera{}, objects);
        EXPECT_FALSE(trackers);
        return trackers ? std::string() : trackers.error().field;
    };
    const auto bounds = [](ColourBounds wrong) {
        ColourSettings settings;
        settings.bounds = wrong;
        return settings;
    };
    EXPECT_EQ(field({}), "objects[0]");
    EXPECT_EQ(field(bounds({.hue_min_deg = kNaN})), "objects[0].hue_deg");
    EXPECT_EQ(field(bounds({.hue_max_deg = 400.0})), "objects[0].hue_deg");
    EXPECT_EQ(field(bounds({.saturation_min = 1.0})), "objects[0].saturation");
    EXPECT_EQ(field(bounds({.value_min = -0.1})), "objects[0].value");
    for (const PictureBox box :
         {PictureBox{-1, 0, 10, 10}, {0, 0, 0, 10}, {635, 0, 10, 10}, {0, 2147483647, 1, 1}}) {
        ColourSettings settings;
        settings.box = box;
        EXPECT_EQ(field(settings), "objects[0].box");
    }
    ColourSettings late;
    late.box = PictureBox{10, 10, 10, 10};
    late.learn_at_s = kNaN;
    EXPECT_EQ(field(late), "objects[0].learn_at_s");
    late.bounds = ColourBounds{};
    EXPECT_EQ(field(late), "objects[0]");
}

TEST(Colour, ARecordingWithoutColourIsRefusedByName) {
    TexturedScene scene(1, 2);
    const PrintedBox box = plain_box(0.0, 0.0);
    auto chain = Chain::create({scene.camera, {{"box", click_on(scene, box)}}});
    ASSERT_TRUE(chain);
    RgbdFrame frame = scene.frame({box});
    RgbdFrame grey = frame;
    grey.rgb.clear();
    ASSERT_TRUE(chain->learn(grey));
    const auto refused = chain->track(grey);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().field, "rgb");
    ASSERT_TRUE(chain->track(frame));
    const auto later = chain->track(grey);  // one picture was lost, that happens
    ASSERT_TRUE(later);
    EXPECT_EQ(later->front().status, TrackStatus::lost);
    frame.rgb.resize(100);
    EXPECT_FALSE(chain->track(frame));
}

}  // namespace
}  // namespace kinectlab
