#include "pipeline/track/texture.hpp"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/followed_box.hpp"

namespace kinectlab {
namespace {

using test::error_of;
using test::front_of;
using test::moving_box;
using test::PrintedBox;
using test::sample_of;
using test::TexturedScene;
using test::tracker_of;

class Texture : public testing::TestWithParam<TextureSpots> {
protected:
    TexturedScene scene_{7};
    [[nodiscard]] TextureSettings settings() const {
        TextureSettings settings;
        settings.spots = GetParam();
        settings.box = front_of(moving_box(0), scene_.camera);
        return settings;
    }
};

INSTANTIATE_TEST_SUITE_P(
    Spots,
    Texture,
    testing::Values(TextureSpots::sift, TextureSpots::binary),
    [](const auto& spots) { return spots.param == TextureSpots::sift ? "Sift" : "Binary"; }
);

TEST_P(Texture, FollowsSixDegreesOfFreedomThroughTwoCameras) {
    scene_.printed_wall = true;
    auto tracker = tracker_of(scene_.camera, settings());
    const PrintedBox at_first = moving_box(0);
    const TrackSample first = sample_of(*tracker, scene_.frame({at_first}));
    ASSERT_EQ(first.status, TrackStatus::tracked);
    EXPECT_LT(Eigen::AngleAxisd(first.q_cam_obj).angle(), 0.005) << "its own first look";

    double place = 0.0, turn = 0.0;
    constexpr int kSteps = 6;
    for (int step = 1; step <= kSteps; ++step) {
        const PrintedBox box = moving_box(step);
        const TrackSample now = sample_of(*tracker, scene_.frame({box}));
        ASSERT_EQ(now.status, TrackStatus::tracked) << step;
        ASSERT_TRUE(now.has_orientation);
        const auto error = error_of(first, at_first, now, box);
        EXPECT_LT(error.place_m.norm(), 0.003) << step;
        EXPECT_LT(error.turn_rad.norm(), 0.035) << step;
        const Matrix6d inverse = now.covariance.inverse();
        place += error.place_m.dot(inverse.topLeftCorner<3, 3>() * error.place_m);
        turn += error.turn_rad.dot(inverse.bottomRightCorner<3, 3>() * error.turn_rad);
        EXPECT_GE(now.quality.points, 8);
        EXPECT_GT(now.quality.inlier_share, 0.15);
    }
    // What it claims to know is about what it knows.
    EXPECT_LT(place / (3 * kSteps), 5.0);
    EXPECT_LT(turn / (3 * kSteps), 5.0);
}

TEST_P(Texture, IsFoundAgainAfterItWasAway) {
    auto tracker = tracker_of(scene_.camera, settings());
    ASSERT_EQ(sample_of(*tracker, scene_.frame({moving_box(0)})).status, TrackStatus::tracked);
    EXPECT_EQ(sample_of(*tracker, scene_.frame({})).status, TrackStatus::lost);
    PrintedBox elsewhere = moving_box(0);
    elsewhere.T_cam_box.translation().x() -= 0.3;
    EXPECT_EQ(sample_of(*tracker, scene_.frame({elsewhere})).status, TrackStatus::tracked);
}

TEST_P(Texture, AnotherPrintIsNotTheObject) {
    auto tracker = tracker_of(scene_.camera, settings());
    ASSERT_EQ(sample_of(*tracker, scene_.frame({moving_box(0)})).status, TrackStatus::tracked);
    PrintedBox other = moving_box(1);
    other.print = 9;
    EXPECT_EQ(sample_of(*tracker, scene_.frame({other})).status, TrackStatus::lost);
}

TEST_P(Texture, ATexturelessObjectIsLost) {
    auto tracker = tracker_of(scene_.camera, settings());
    PrintedBox plain = moving_box(0);
    plain.print = 0;
    for (int i = 0; i < 2; ++i)
        EXPECT_EQ(sample_of(*tracker, scene_.frame({plain})).status, TrackStatus::lost);
}

TEST_P(Texture, WithoutABoxItIsWhatMovedFirst) {
    TextureSettings boxless = settings();
    boxless.box.reset();
    auto tracker = tracker_of(scene_.camera, boxless);
    const RgbdFrame frame = scene_.frame({moving_box(0)});
    EXPECT_EQ(sample_of(*tracker, frame).status, TrackStatus::lost) << "nothing moved";
    std::vector<std::uint32_t> nearer;
    for (std::uint32_t i = 0; i < frame.depth.size(); ++i)
        if (frame.depth[i] < 1300) nearer.push_back(i);
    const std::vector<MovedPixels> moved{nearer};
    const TrackSample sample = sample_of(*tracker, frame, moved);
    ASSERT_EQ(sample.status, TrackStatus::tracked);
    EXPECT_NEAR(sample.p_cam.z(), 0.96, 0.02);
}

TEST_P(Texture, BlindFramesAreLost) {
    auto tracker = tracker_of(scene_.camera, settings());
    const RgbdFrame seen = scene_.frame({moving_box(0)});
    RgbdFrame blind = seen;
    std::fill(blind.depth.begin(), blind.depth.end(), 0);
    EXPECT_EQ(sample_of(*tracker, blind).status, TrackStatus::lost) << "nothing to learn";
    EXPECT_EQ(sample_of(*tracker, seen).status, TrackStatus::tracked);
    EXPECT_EQ(sample_of(*tracker, blind).status, TrackStatus::lost);
    blind = seen;
    blind.rgb.clear();
    EXPECT_EQ(sample_of(*tracker, blind).status, TrackStatus::lost);
    tracker->reset();
    EXPECT_EQ(sample_of(*tracker, seen).status, TrackStatus::tracked);
}

TEST(TextureSettingsCheck, NamesTheField) {
    const auto field = [](const TextureSettings& settings) {
        const std::vector<ObjectSpec> objects{{"box", settings}};
        const auto trackers = make_trackers(RgbdCamera{}, objects);
        EXPECT_FALSE(trackers);
        return trackers ? std::string() : trackers.error().field;
    };
    EXPECT_EQ(field({.box = PictureBox{600, 0, 100, 100}}), "objects[0].box");
    EXPECT_EQ(field({.box = PictureBox{0, 0, 0, 5}}), "objects[0].box");
    EXPECT_EQ(field({.learn_at_s = -1.0}), "objects[0].learn_at_s");
    EXPECT_EQ(
        field({.learn_at_s = std::numeric_limits<double>::quiet_NaN()}), "objects[0].learn_at_s"
    );
    EXPECT_EQ(field({.fewest_spots = 3}), "objects[0].fewest_spots");
}

}  // namespace
}  // namespace kinectlab
