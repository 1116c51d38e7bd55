#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "pipeline/sensor/recording.hpp"

namespace kinectlab {
namespace {

std::filesystem::path shared_data() {
    if (const char* given = std::getenv("KINECTLAB_SHARED_DATA")) return given;
    return std::filesystem::path(KINECTLAB_SOURCE_DIR) / "../shared/data";
}

/// Eleven frames of a real Xtion, the first of them the reference.
TEST(ChainOnRealFrames, NothingMovesThenTwoBoxesAreThere) {
    const auto folder = shared_data() / "xtion_boxes";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no recordings of real sensors at " << folder;
    auto source = open_recording(folder);
    ASSERT_TRUE(source) << to_text(source.error());
    const ObjectSpec moved{"moved", ChangeTrackSettings{}};
    auto chain = Chain::create({(*source)->info().camera, {moved}});
    ASSERT_TRUE(chain) << to_text(chain.error());

    RgbdFrame frame;
    for (int number = 1; number <= 11; ++number) {
        const auto status = (*source)->next(frame, std::chrono::milliseconds(1000));
        ASSERT_TRUE(status) << to_text(status.error());
        ASSERT_EQ(*status, FrameStatus::frame);
        if (number == 1) {
            ASSERT_TRUE(chain->learn(frame));
            continue;
        }
        const auto samples = chain->track(frame);
        ASSERT_TRUE(samples);
        EXPECT_EQ(samples->size(), number <= 8 ? 0U : 2U) << "frame " << number;
        for (const auto& sample : *samples)
            EXPECT_GT(sample.quality.points, 1000) << "frame " << number;
    }
}

}  // namespace
}  // namespace kinectlab
