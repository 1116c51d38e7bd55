#include "pipeline/sensor/clock_map.hpp"

#include <random>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

constexpr TimeNs kUtc = 1'700'000'000 * kNsPerSecond;
constexpr TimeNs kTransfer = 8'000'000;

// A device that counts from 0 at kUtc, read by a computer that is now and then late.
struct Device {
    double drift = 0.0;
    std::mt19937 random{7};
    std::exponential_distribution<double> late{1.0 / 2e6};  // ns

    struct Reading {
        std::uint64_t device_us;
        TimeNs true_utc;
        TimeNs arrival;
    };
    Reading at(int frame) {
        const double t = frame / 30.0;
        const TimeNs true_utc = kUtc + from_seconds(t);
        const TimeNs delay = kTransfer + static_cast<TimeNs>(late(random));
        return {static_cast<std::uint64_t>(t * (1.0 + drift) * 1e6), true_utc, true_utc + delay};
    }
};

TEST(ClockMap, LateReadingsDoNotMoveTheTimes) {
    Device device;
    ClockMap clock;
    double largest_step_error = 0.0;
    TimeNs before = 0;
    for (int k = 0; k < 3000; ++k) {
        auto reading = device.at(k);
        if (k % 97 == 50) reading.arrival += 300'000'000;  // the computer was busy
        const TimeNs t = clock.map(reading.device_us, reading.arrival);
        if (k > 60) {
            EXPECT_NEAR(to_seconds(t - reading.true_utc - kTransfer), 0.0, 1.5e-3) << k;
            const double step_error = to_seconds(t - before) - 1.0 / 30.0;
            largest_step_error = std::max(largest_step_error, std::abs(step_error));
        }
        before = t;
    }
    EXPECT_LT(largest_step_error, 3e-6);  // of 33 ms: the device's own microseconds
}

TEST(ClockMap, HeldItKeepsTheDevicesRateHoweverLateTheFirstReadingsWere) {
    Device device;
    ClockMap clock;
    TimeNs first = 0, last = 0;
    constexpr int kHeldFrom = 60, kEnd = 60 + 30 * 20;
    for (int k = 0; k <= kEnd; ++k) {
        auto reading = device.at(k);
        if (k < 40) reading.arrival += 60'000'000;  // the computer was busy as it began
        if (k == kHeldFrom) clock.hold(true);
        last = clock.map(reading.device_us, reading.arrival);
        if (k == kHeldFrom) first = last;
    }
    EXPECT_NEAR(to_seconds(last - first), 20.0, 2e-6);
    clock.hold(false);
    double nearest = 1.0;
    for (int k = kEnd + 1; k < kEnd + 30 * 600; ++k) {
        const auto reading = device.at(k);
        const TimeNs t = clock.map(reading.device_us, reading.arrival);
        nearest = std::abs(to_seconds(t - reading.true_utc - kTransfer));
    }
    EXPECT_LT(nearest, 2e-3);  // and then it finds back
}

TEST(ClockMap, FollowsAClockThatDrifts) {
    Device device;
    device.drift = 50e-6;
    ClockMap clock;
    for (int k = 0; k < 30 * 3600; ++k) {
        const auto reading = device.at(k);
        const TimeNs t = clock.map(reading.device_us, reading.arrival);
        if (k > 60) {
            ASSERT_NEAR(to_seconds(t - reading.true_utc - kTransfer), 0.0, 8e-3) << k;
        }
    }
}

TEST(ClockMap, TimesAlwaysIncrease) {
    ClockMap clock(kUtc + kNsPerSecond);  // frames were delivered up to there before a reconnection
    TimeNs before = kUtc + kNsPerSecond;
    Device device;
    for (int k = 0; k < 600; ++k) {
        auto reading = device.at(k);
        if (k < 10) reading.arrival += (10 - k) * 50'000'000;  // a slow start
        if (k > 300) reading.arrival -= 3600 * kNsPerSecond;   // the wall clock was set back
        const TimeNs t = clock.map(reading.device_us, reading.arrival);
        ASSERT_GT(t, before) << k;
        before = t;
    }
}

TEST(ClockMap, FollowsAWallClockThatWasSetForward) {
    ClockMap clock;
    Device device;
    TimeNs t = 0;
    for (int k = 0; k < 900; ++k) {
        auto reading = device.at(k);
        if (k >= 300) reading.arrival += 3600 * kNsPerSecond;
        t = clock.map(reading.device_us, reading.arrival);
    }
    EXPECT_NEAR(to_seconds(t - kUtc), 3600 + 899 / 30.0, 0.05);
}

}  // namespace
}  // namespace kinectlab
