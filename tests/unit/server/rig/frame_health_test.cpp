#include "server/rig/frame_health.hpp"

#include <gtest/gtest.h>

namespace kinectlab::rig {
namespace {

constexpr TimeNs kPeriod = kNsPerSecond / 30;

TEST(FrameHealth, MeasuresTheRateAndLetsItFallInSilence) {
    FrameHealth health;
    TimeNs t = 0;
    for (std::uint64_t i = 0; i < 120; ++i)
        EXPECT_EQ(health.on_frame(i, t += kPeriod), 0U);
    EXPECT_NEAR(health.rate_hz(t), 30.0, 0.01);
    EXPECT_LT(health.rate_hz(t + 2 * kNsPerSecond), 20.0);
    EXPECT_EQ(health.rate_hz(t + 4 * kNsPerSecond), 0.0);
    EXPECT_EQ(health.lost(), 0);
}

TEST(FrameHealth, CountsGapsButNotADeviceThatBeganAgain) {
    FrameHealth health;
    health.on_frame(10, kPeriod);
    EXPECT_EQ(health.on_frame(14, 2 * kPeriod), 3U);
    EXPECT_EQ(health.on_frame(0, 3 * kPeriod), 0U);
    EXPECT_EQ(health.on_frame(1, 4 * kPeriod), 0U);
    EXPECT_EQ(health.lost(), 3);
}

}  // namespace
}  // namespace kinectlab::rig
