// The live source against the simulated rig's driver, which OpenNI2 loads as it would a Kinect's.
#include "pipeline/sensor/openni_source.hpp"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/drivers/simulated_rig/protocol.hpp"

namespace kinectlab {
namespace {

using namespace std::chrono_literals;
using simulated_rig::Fault;
using simulated_rig::FaultKind;
using Clock = std::chrono::steady_clock;

constexpr auto kLongEnough = 60s;  // far beyond what anything here takes

bool make(OpenniSource& source, std::string_view apparatus) {
    return source.set_property(simulated_rig::kApparatus, std::as_bytes(std::span(apparatus)));
}

template <class T>
bool set(OpenniSource& source, int id, const T& value) {
    return source.set_property(id, std::as_bytes(std::span(&value, 1)));
}

std::unique_ptr<OpenniSource> open(const std::string& uri) {
    auto source = OpenniSource::open({.uri = uri});
    EXPECT_TRUE(source) << to_text(source.error());
    return source ? std::move(*source) : nullptr;
}

// Asks for frames until one comes back with the wanted status.
bool wait_for(OpenniSource& source, RgbdFrame& frame, FrameStatus wanted) {
    const auto deadline = Clock::now() + kLongEnough;
    while (Clock::now() < deadline) {
        const auto status = source.next(frame, 200ms);
        if (!status) return false;
        if (*status == wanted) return true;
    }
    return false;
}

TimeNs utc_now() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch()
    )
        .count();
}

TEST(OpenniSource, PairsDepthAndColourOnTheWallClock) {
    const auto source = open("sim://source-pairs?noise=none");
    ASSERT_TRUE(source);
    EXPECT_EQ(source->info().name, "sim://source-pairs?noise=none");
    EXPECT_EQ(source->info().frame_rate_hz, 30.0);
    EXPECT_EQ(source->info().camera.depth.fx, 580.0);
    EXPECT_EQ(source->info().camera.colour.fx, 525.0);
    EXPECT_NE(source->info().camera.T_colour_depth.translation().x(), 0.0);
    EXPECT_TRUE(source->info().T_lab_cam);

    RgbdFrame frame;
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    const TimeNs first_t = frame.t;
    // Where the first frame came late, the clocks' offset is right after a second only.
    while (frame.t < first_t + kNsPerSecond * 12 / 10)
        ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    for (int matched = 0; matched < 5;) {
        const std::uint64_t last_index = frame.index;
        const TimeNs last_t = frame.t;
        ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
        const TimeNs now = utc_now();
        EXPECT_EQ(frame.depth.size(), 640u * 480u);
        if (!frame.rgb.empty()) {
            EXPECT_EQ(frame.rgb.size(), 3u * 640u * 480u);
            EXPECT_LE(std::abs(frame.t - frame.t_colour), kNsPerSecond / 60);
        }
        EXPECT_LT(frame.t, now);
        EXPECT_GT(frame.t, now - 5 * kNsPerSecond);
        EXPECT_GT(frame.index, last_index);
        EXPECT_GT(frame.t, last_t);
        if (last_t - first_t < 3 * kNsPerSecond / 2) continue;
        // After the first second the clocks are matched: a step in time is the device's own.
        const double steps = static_cast<double>(frame.index - last_index);
        EXPECT_NEAR(to_seconds(frame.t - last_t), steps / 30.0, 1e-4);
        ++matched;
    }
    EXPECT_FALSE(frame.rgb.empty());
}

TEST(OpenniSource, WithoutColourGivesDepthAlone) {
    auto source =
        OpenniSource::open({.uri = "sim://source-depth?noise=none", .with_colour = false});
    ASSERT_TRUE(source) << to_text(source.error());
    RgbdFrame frame;
    ASSERT_TRUE(wait_for(**source, frame, FrameStatus::frame));
    EXPECT_TRUE(frame.rgb.empty());
    EXPECT_EQ(frame.t_colour, 0);
}

TEST(OpenniSource, KeepsItsBuffersOnceWarm) {
    const auto source = open("sim://source-buffers?noise=none");
    ASSERT_TRUE(source);
    RgbdFrame frame;
    std::vector<const void*> seen;
    for (int k = 0; k < 12; ++k) {
        ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
        if (k >= 4) seen.push_back(frame.depth.data());
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    EXPECT_LE(seen.size(), 2u);  // the caller's and the one being filled
}

TEST(OpenniSource, PropertiesPassThroughFromAnotherThread) {
    const auto source = open("sim://source-properties?noise=none");
    ASSERT_TRUE(source);
    bool fine = false;
    std::thread other([&] {
        fine = make(*source, "pendulum length_m=0.7");
        const std::string_view wanted = "pendulum length_m=0.7";
        std::string now(wanted.size() + 1, '?');  // its closing zero too
        fine =
            fine &&
            source->get_property(simulated_rig::kApparatus, std::as_writable_bytes(std::span(now)));
        fine = fine && now.c_str() == wanted;
    });
    RgbdFrame frame;
    EXPECT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    other.join();
    EXPECT_TRUE(fine);
    EXPECT_FALSE(set(*source, 12345, 1));
}

TEST(OpenniSource, ComesBackAfterItWasUnplugged) {
    const auto source = open("sim://source-unplugged?noise=none");
    ASSERT_TRUE(source);
    RgbdFrame frame;
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    const std::uint64_t last_index = frame.index;
    const TimeNs last_t = frame.t;

    ASSERT_TRUE(set(*source, simulated_rig::kFault, Fault{FaultKind::unplugged, 0, 1.5}));
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::disconnected));
    EXPECT_FALSE(make(*source, "pendulum"));
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    EXPECT_GT(frame.t, last_t + kNsPerSecond);
    EXPECT_GT(frame.index, last_index + 20);  // what was missed shows as a gap
    EXPECT_TRUE(make(*source, "pendulum"));
    const TimeNs back = frame.t;
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    EXPECT_GT(frame.t, back);
}

TEST(OpenniSource, ADeviceThatHangsCountsAsGone) {
    const auto source = open("sim://source-frozen?noise=none");
    ASSERT_TRUE(source);
    RgbdFrame frame;
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    ASSERT_TRUE(set(*source, simulated_rig::kFault, Fault{FaultKind::frozen, 0, 3.5}));
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::disconnected));
    const TimeNs last_t = frame.t;
    ASSERT_TRUE(wait_for(*source, frame, FrameStatus::frame));
    EXPECT_GT(frame.t, last_t);
}

TEST(OpenniSource, ADeviceThatIsNotThereIsAnErrorThatNamesIt) {
    const auto source = OpenniSource::open({.uri = "usb://nothing-like-this"});
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().code, ErrorCode::unavailable);
    EXPECT_EQ(source.error().field, "usb://nothing-like-this");
    EXPECT_THAT(source.error().cure, testing::HasSubstr("sim://pendulum"));
}

}  // namespace
}  // namespace kinectlab
