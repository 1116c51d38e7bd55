#include "pipeline/simulate/depth_noise.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/simulate/simulated_rig.hpp"

namespace kinectlab::simulate {
namespace {

constexpr int kWidth = 640;

RgbdFrame frame_of(NoiseModel noise, std::uint64_t seed = 1, double t_s = 0.0) {
    RigSettings settings;
    settings.noise = noise;
    settings.seed = seed;
    settings.with_colour = false;
    auto rig = SimulatedRig::create(settings);
    EXPECT_TRUE(rig);
    rig->advance_to(t_s);
    RgbdFrame frame;
    rig->render(frame);
    return frame;
}

/// Disparity steps off the wall's, for a window of bare wall at 3.2 m; lost pixels are left out.
constexpr double kWallDisparity = (3.0 - 1.0 / 3.2) / 2.85e-3;
double steps_off_wall(const RgbdFrame& frame, int u, int v) {
    const double z = frame.depth[static_cast<std::size_t>(v) * kWidth + u] * 1e-3;
    return std::round((3.0 - 1.0 / z) / 2.85e-3) - kWallDisparity;
}

struct WallNoise {
    double mean, sigma, with_neighbour, lost;
};
WallNoise wall_noise(const RgbdFrame& frame) {
    double sum = 0.0, squares = 0.0, products = 0.0, lost = 0.0;
    int n = 0;
    for (int v = 10; v < 240; ++v) {
        for (int u = 360; u < 620; ++u) {
            const auto i = static_cast<std::size_t>(v) * kWidth + u;
            if (frame.depth[i] == 0 || frame.depth[i + 1] == 0) {
                lost += 1.0;
                continue;
            }
            const double here = steps_off_wall(frame, u, v);
            sum += here;
            squares += here * here;
            products += here * steps_off_wall(frame, u + 1, v);
            ++n;
        }
    }
    const double mean = sum / n;
    const double variance = squares / n - mean * mean;
    return {mean, std::sqrt(variance), (products / n - mean * mean) / variance, lost / n};
}

const double kSigma = std::sqrt(0.25 + 1.0 / 12.0);

TEST(DepthNoise, IsHalfADisparityStepAndItsRounding) {
    const WallNoise noise = wall_noise(frame_of(NoiseModel::khoshelham));
    EXPECT_NEAR(noise.mean, 0.0, 0.02);
    EXPECT_NEAR(noise.sigma, kSigma, 0.02 * kSigma);
    EXPECT_NEAR(noise.with_neighbour, 0.0, 0.03);
    EXPECT_EQ(noise.lost, 0.0);
}

TEST(DepthNoise, OfTheKinectIsAsStrongButSharedByNeighbours) {
    const WallNoise noise = wall_noise(frame_of(NoiseModel::kinect));
    EXPECT_NEAR(noise.mean, 0.0, 0.04);
    EXPECT_NEAR(noise.sigma, kSigma, 0.05 * kSigma);
    EXPECT_GT(noise.with_neighbour, 0.3);
    EXPECT_GT(noise.lost, 0.0);
    EXPECT_LT(noise.lost, 0.01);
}

TEST(DepthNoise, ComesInDisparitySteps) {
    const RgbdFrame frame = frame_of(NoiseModel::khoshelham);
    for (const std::uint16_t mm : frame.depth) {
        if (mm == 0) continue;
        const double disparity = (3.0 - 1000.0 / mm) / 2.85e-3;
        const double one_mm = 1000.0 / mm / mm / 2.85e-3;
        ASSERT_LT(std::abs(disparity - std::round(disparity)), 0.51 * one_mm) << mm;
    }
}

TEST(DepthNoise, WithoutNoiseTheWallStandsStill) {
    const RgbdFrame frame = frame_of(NoiseModel::none);
    for (int v = 10; v < 240; ++v)
        ASSERT_EQ(frame.depth[static_cast<std::size_t>(v) * kWidth + 600], 3200);
}

TEST(DepthNoise, DependsOnSeedAndFrameOnly) {
    RigSettings settings;
    settings.with_colour = false;
    auto every_frame = SimulatedRig::create(settings);
    ASSERT_TRUE(every_frame);
    RgbdFrame seen;
    for (int k = 0; k <= 7; ++k) {
        every_frame->advance_to(k / kFrameRateHz);
        every_frame->render(seen);
    }
    EXPECT_EQ(seen.index, 7U);
    EXPECT_EQ(seen.depth, frame_of(NoiseModel::kinect, 1, 7 / kFrameRateHz).depth);
    EXPECT_NE(seen.depth, frame_of(NoiseModel::kinect, 2, 7 / kFrameRateHz).depth);
    EXPECT_NE(seen.depth, frame_of(NoiseModel::kinect, 1, 8 / kFrameRateHz).depth);
}

TEST(DepthNoise, ShadowLiesLeftOfTheBobAndTheTableHasHoles) {
    const RgbdFrame frame = frame_of(NoiseModel::kinect);
    // The bob hangs at (0, 0, 0.9): 1.55 m away, 25 cm below the camera.
    const int row = static_cast<int>(239.5 + 0.25 / 1.6 * 580.0);
    const int edge = static_cast<int>(0.05 / 1.6 * 580.0);
    const auto lost = [&](int from, int to) {
        int count = 0;
        for (int v = row - 4; v <= row + 4; ++v)
            for (int u = from; u < to; ++u)
                count += frame.depth[static_cast<std::size_t>(v) * kWidth + u] == 0 ? 1 : 0;
        return static_cast<double>(count) / (9 * (to - from));
    };
    EXPECT_GT(lost(320 - edge - 9, 320 - edge - 2), 0.95);
    EXPECT_LT(lost(320 - edge - 40, 320 - edge - 25), 0.05);
    EXPECT_LT(lost(320 + edge + 4, 320 + edge + 30), 0.05);
    EXPECT_LT(lost(310, 330), 0.06);
    int holes = 0;
    for (int v = 365; v < 435; ++v)
        for (int u = 100; u < 540; ++u)
            holes += frame.depth[static_cast<std::size_t>(v) * kWidth + u] == 0 ? 1 : 0;
    EXPECT_GT(holes, 500);
}

TEST(DepthNoise, KnowsItsModelsByName) {
    EXPECT_EQ(noise_model_named("khoshelham"), NoiseModel::khoshelham);
    ASSERT_FALSE(noise_model_named("loud"));
    EXPECT_EQ(noise_model_named("loud").error().field, "noise");
}

}  // namespace
}  // namespace kinectlab::simulate
