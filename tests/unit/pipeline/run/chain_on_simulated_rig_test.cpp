#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "pipeline/simulate/pendulum.hpp"
#include "pipeline/simulate/simulate_run.hpp"

namespace kinectlab {
namespace {

struct Outcome {
    int swinging = 0, lost = 0, false_tracks = 0;
    int longest_gap = 0;
    double mean_square_over_claimed = 0.0;
};

/// The whole run of a rig: at rest, displaced, held, swinging; only the rest is learned.
Outcome outcome_of(simulate::NoiseModel noise, double seconds) {
    simulate::RunSettings run;
    run.rig.noise = noise;
    run.rig.with_colour = false;
    run.seconds = seconds;
    const auto rig = simulate::SimulatedRig::create(run.rig);
    const ObjectSpec bob{
        "bob", SphereSettings{.radius_m = simulate::PendulumParameters().bob_radius_m}};
    Chain chain = std::move(Chain::create({rig->camera(), {bob}}).value());
    const Eigen::Isometry3d T_cam_lab = rig->T_lab_cam().inverse();

    Outcome outcome;
    int gap = 0;
    const auto sink = [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
        if (to_seconds(frame.t - run.rig.start) < 1.5) return chain.learn(frame);
        const auto sample = chain.track(frame).value().front();
        const bool tracked = sample.status == TrackStatus::tracked;
        const Eigen::Vector3d error = sample.p_cam - T_cam_lab * truth.body().p_lab;
        if (tracked && error.norm() > 0.005) ++outcome.false_tracks;
        if (truth.motion != simulate::Motion::free) return {};
        ++outcome.swinging;
        gap = tracked ? 0 : gap + 1;
        outcome.longest_gap = std::max(outcome.longest_gap, gap);
        if (!tracked) ++outcome.lost;
        const Eigen::Matrix3d covariance = sample.covariance.topLeftCorner<3, 3>();
        if (tracked)
            outcome.mean_square_over_claimed += error.dot(covariance.inverse() * error) / 3.0;
        return {};
    };
    EXPECT_TRUE(simulate::simulate_run(run, sink));
    outcome.mean_square_over_claimed /= outcome.swinging - outcome.lost;
    return outcome;
}

TEST(ChainOnSimulatedRig, FollowsTheBobWithIndependentNoise) {
    const Outcome outcome = outcome_of(simulate::NoiseModel::khoshelham, 6.0);
    EXPECT_EQ(outcome.false_tracks, 0);
    EXPECT_EQ(outcome.lost, 0) << "of " << outcome.swinging;
    EXPECT_GT(outcome.mean_square_over_claimed, 0.7);
    EXPECT_LT(outcome.mean_square_over_claimed, 1.5);
}

TEST(ChainOnSimulatedRig, FollowsTheBobWithAKinectsNoise) {
    const Outcome outcome = outcome_of(simulate::NoiseModel::kinect, 20.0);
    EXPECT_EQ(outcome.false_tracks, 0);
    EXPECT_LT(outcome.lost, outcome.swinging / 50);
    EXPECT_LE(outcome.longest_gap, 3);
    // Neighbouring pixels err together; the claim must say so.
    EXPECT_GT(outcome.mean_square_over_claimed, 0.4);
    EXPECT_LT(outcome.mean_square_over_claimed, 2.0);
}

/// Of a room whose wall is three metres away, and of a bob that swings.
TEST(ChainOnSimulatedRig, VoxelsFindTheBobAndNothingElse) {
    simulate::RunSettings run;
    run.rig.with_colour = false;
    run.seconds = 6.0;
    run.rig.seed = 7;
    const auto rig = simulate::SimulatedRig::create(run.rig);
    PreprocessSettings settings;
    settings.change.method = ChangeMethod::octree;
    const ObjectSpec moved{"moved", ChangeTrackSettings{}};
    Chain chain = std::move(Chain::create({rig->camera(), {moved}, settings}).value());
    std::size_t swinging = 0, seen = 0;
    std::uint32_t things = 0;
    const auto sink = [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
        if (to_seconds(frame.t - run.rig.start) < 1.5) return chain.learn(frame);
        swinging += truth.motion == simulate::Motion::free ? 1 : 0;
        const auto samples = chain.track(frame).value();
        for (const auto& sample : samples) {
            things = std::max(things, sample.identity);
            const bool counts =
                truth.motion == simulate::Motion::free && sample.status == TrackStatus::tracked;
            seen += counts ? 1 : 0;
        }
        return {};
    };
    ASSERT_TRUE(simulate::simulate_run(run, sink));
    EXPECT_EQ(things, 1U);
    EXPECT_GT(seen, swinging * 9 / 10);
}

}  // namespace
}  // namespace kinectlab
