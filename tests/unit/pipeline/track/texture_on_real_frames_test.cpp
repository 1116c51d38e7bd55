#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "pipeline/sensor/recording.hpp"
#include "tests/unit/pipeline/support/shared_data.hpp"

namespace kinectlab {
namespace {

/// Eleven frames of a real Xtion whose cameras are not registered and whose brightness wanders; in
/// the last three the brown box stays and the yellow one is moved away.
void follow_both_boxes(MethodSettings yellow, MethodSettings brown, double least_move_m) {
    const auto folder = test::shared_data() / "xtion_boxes";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no recordings of real sensors at " << folder;
    auto source = open_recording(folder);
    ASSERT_TRUE(source) << to_text(source.error());
    const std::vector<ObjectSpec> boxes{{"yellow", std::move(yellow)}, {"brown", std::move(brown)}};
    auto chain = Chain::create({(*source)->info().camera, boxes});
    ASSERT_TRUE(chain) << to_text(chain.error());

    RgbdFrame frame;
    std::vector<Eigen::Vector3d> moved, stays;
    for (int number = 1; number <= 11; ++number) {
        ASSERT_EQ((*source)->next(frame, std::chrono::milliseconds(1000)), FrameStatus::frame);
        if (number == 1) {
            ASSERT_TRUE(chain->learn(frame));
        }
        const auto samples = chain->track(frame);
        ASSERT_TRUE(samples) << to_text(samples.error());
        ASSERT_EQ(samples->size(), 2U);
        for (const auto& sample : *samples) {
            EXPECT_EQ(sample.status == TrackStatus::tracked, number >= 9)
                << boxes[sample.object].name << " in frame " << number;
            if (sample.status == TrackStatus::tracked)
                (sample.object == 0 ? moved : stays).push_back(sample.p_cam);
        }
    }
    ASSERT_EQ(moved.size(), 3U);
    ASSERT_EQ(stays.size(), 3U);
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_LT((stays[i] - stays[0]).norm(), 0.005) << (stays[i] - stays[0]).transpose();
        EXPECT_GT(moved[i].z() - moved[i - 1].z(), least_move_m) << "it goes away";
    }
}

constexpr double kFrame9_s = 8.0;
constexpr PictureBox kYellow{405, 142, 85, 100}, kBrown{282, 100, 90, 140};

TEST(TextureOnRealFrames, BothBoxesBySift) {
    const TextureSettings yellow{.box = kYellow, .learn_at_s = kFrame9_s};
    const TextureSettings brown{.box = kBrown, .learn_at_s = kFrame9_s};
    follow_both_boxes(yellow, brown, 0.06);
}

TEST(TextureOnRealFrames, BothBoxesByBinarySpots) {
    const TextureSettings yellow{
        .box = kYellow, .learn_at_s = kFrame9_s, .spots = TextureSpots::binary};
    const TextureSettings brown{
        .box = kBrown, .learn_at_s = kFrame9_s, .spots = TextureSpots::binary};
    follow_both_boxes(yellow, brown, 0.06);
}

TEST(TextureOnRealFrames, BothBoxesBySpotsInSpace) {
    const Sift3dTrackSettings yellow{.box = kYellow, .learn_at_s = kFrame9_s};
    const Sift3dTrackSettings brown{.box = kBrown, .learn_at_s = kFrame9_s};
    follow_both_boxes(yellow, brown, 0.06);
}

TEST(TextureOnRealFrames, TheYellowBoxByItsColourAndTheBrownByItsTexture) {
    const ColourSettings yellow{.box = kYellow, .learn_at_s = kFrame9_s};
    const TextureSettings brown{.box = kBrown, .learn_at_s = kFrame9_s};
    follow_both_boxes(yellow, brown, 0.06);
}

}  // namespace
}  // namespace kinectlab
