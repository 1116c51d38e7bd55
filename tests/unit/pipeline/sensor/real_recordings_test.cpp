// Recordings of real sensors; skipped where they are not.
#include <gtest/gtest.h>

#include "pipeline/sensor/recording.hpp"
#include "tests/unit/pipeline/sensor/scratch_folder.hpp"

namespace kinectlab {
namespace {

using namespace std::chrono_literals;

std::filesystem::path real(const std::string& name) {
    const auto folder = test::shared_data();
    return folder.empty() ? folder : folder / name;
}

#define SKIP_WITHOUT_SHARED_DATA() \
    if (test::shared_data().empty()) GTEST_SKIP() << "no ../shared/data with real recordings"

double share_of_readings(const RgbdFrame& frame) {
    const auto zeros = std::count(frame.depth.begin(), frame.depth.end(), 0);
    return 1.0 - static_cast<double>(zeros) / static_cast<double>(frame.depth.size());
}

TEST(RealRecordings, XtionBoxesHasTwoCameras) {
    SKIP_WITHOUT_SHARED_DATA();
    auto source = open_recording(real("xtion_boxes"));
    ASSERT_TRUE(source) << to_text(source.error());
    const auto& camera = (*source)->info().camera;
    EXPECT_EQ((*source)->info().frame_count, 11u);
    EXPECT_NEAR(camera.depth.fx, 567.9, 0.1);
    EXPECT_NEAR(camera.colour.fx, 534.3, 0.1);
    EXPECT_NEAR(camera.T_colour_depth.translation().x(), -0.0263, 1e-4);
    EXPECT_EQ(camera.depth_unit_m, 0.001);
    RgbdFrame frame;
    for (int k = 0; k < 11; ++k) {
        const auto status = (*source)->next(frame, 1s);
        ASSERT_TRUE(status) << to_text(status.error());
        ASSERT_EQ(*status, FrameStatus::frame);
        EXPECT_EQ(frame.t, k * kNsPerSecond);
        EXPECT_GT(share_of_readings(frame), 0.5);
    }
    EXPECT_EQ((*source)->next(frame, 1s), FrameStatus::end);
}

TEST(RealRecordings, EveryOsdCloudIsARecordingOfOneFrame) {
    SKIP_WITHOUT_SHARED_DATA();
    int read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(real("pcl"))) {
        if (entry.path().filename().string().rfind("osd_", 0) != 0) continue;
        auto source = open_recording(entry.path());
        ASSERT_TRUE(source) << to_text(source.error());
        RgbdFrame frame;
        const auto status = (*source)->next(frame, 1s);
        ASSERT_TRUE(status) << to_text(status.error());
        EXPECT_EQ(frame.depth.size(), 640u * 480u);
        EXPECT_EQ(frame.rgb.size(), 3u * 640u * 480u);
        EXPECT_GT(share_of_readings(frame), 0.3) << entry.path();
        EXPECT_EQ((*source)->next(frame, 1s), FrameStatus::end);
        ++read;
    }
    EXPECT_GE(read, 5);
}

TEST(RealRecordings, AKinectsOniGivesAllItsFramesUnmirrored) {
    SKIP_WITHOUT_SHARED_DATA();
    auto source = open_recording(real("kinect1_oni") / "test.oni");
    ASSERT_TRUE(source) << to_text(source.error());
    EXPECT_EQ((*source)->info().frame_count, 12u);
    EXPECT_NEAR((*source)->info().camera.depth.fx, 575.8, 0.1);
    RgbdFrame frame;
    TimeNs last = -1;
    std::uint64_t left = 0;
    std::uint64_t right = 0;
    for (int k = 0; k < 12; ++k) {
        const auto status = (*source)->next(frame, 1s);
        ASSERT_TRUE(status) << to_text(status.error());
        ASSERT_EQ(*status, FrameStatus::frame);
        EXPECT_GT(frame.t, last);
        EXPECT_EQ(frame.rgb.size(), 3u * 640u * 480u);
        EXPECT_LT(std::abs(frame.t - frame.t_colour), kNsPerSecond / 60);
        last = frame.t;
        for (std::size_t v = 0; v < 480; ++v) {
            for (std::size_t u = 0; u < 100; ++u) {
                left += frame.depth[v * 640 + u];
                right += frame.depth[v * 640 + 639 - u];
            }
        }
    }
    EXPECT_EQ((*source)->next(frame, 1s), FrameStatus::end);
    // As recorded, mirrored, the hundred columns at the left hold 23.5 million millimetres a frame.
    EXPECT_NEAR(static_cast<double>(right) / 12, 23.5e6, 0.3e6);
    EXPECT_GT(std::abs(static_cast<double>(left) / 12 - 23.5e6), 0.3e6);
}

TEST(RealRecordings, AnOniThatIsNoneIsAnError) {
    const test::ScratchFolder scratch;
    test::write_text(scratch / "a.oni", "hello");
    const auto source = open_recording(scratch / "a.oni");
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().code, ErrorCode::bad_data);
}

}  // namespace
}  // namespace kinectlab
