#include "pipeline/track/sift3d.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "pipeline/track/sift3d_model.hpp"
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

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(Sift3d, FollowsSixDegreesOfFreedom) {
    TexturedScene scene(7);
    const PrintedBox at_first = moving_box(0);
    auto tracker =
        tracker_of(scene.camera, Sift3dTrackSettings{.box = front_of(at_first, scene.camera)});
    const TrackSample first = sample_of(*tracker, scene.frame({at_first}));
    ASSERT_EQ(first.status, TrackStatus::tracked);
    for (int step = 1; step <= 3; ++step) {
        const PrintedBox box = moving_box(step);
        const TrackSample now = sample_of(*tracker, scene.frame({box}));
        ASSERT_EQ(now.status, TrackStatus::tracked) << step;
        const auto error = error_of(first, at_first, now, box);
        EXPECT_LT(error.place_m.norm(), 0.004) << step;
        EXPECT_LT(error.turn_rad.norm(), 0.07) << step;
        const Matrix6d inverse = now.covariance.inverse();
        EXPECT_LT(error.place_m.dot(inverse.topLeftCorner<3, 3>() * error.place_m), 25.0);
    }
    EXPECT_EQ(sample_of(*tracker, scene.frame({})).status, TrackStatus::lost);
}

/// A flat patch with one dark blob of this σ, points a millimetre apart.
std::vector<ValuedPoint> blob(const Eigen::Vector2f& at, float sigma_m) {
    std::vector<ValuedPoint> points;
    for (int v = -60; v <= 60; ++v)
        for (int u = -60; u <= 60; ++u) {
            const Eigen::Vector2f p(0.001F * static_cast<float>(u), 0.001F * static_cast<float>(v));
            const float value =
                0.8F - 0.6F * std::exp(-0.5F * (p - at).squaredNorm() / (sigma_m * sigma_m));
            points.push_back({{p.x(), p.y(), 1.0F}, value});
        }
    return points;
}

TEST(Sift3dKeypoints, ABlobIsOneSpotInItsPlaceAndOfItsSize) {
    const Eigen::Vector2f at(0.0113F, -0.0074F);
    const Sift3dSettings settings{.smallest_scale_m = 0.003F};
    const auto octaves = surface_scale_space(blob(at, 0.008F), settings);
    ASSERT_EQ(octaves.size(), 3U);
    const auto keypoints = sift3d_keypoints(octaves, settings);
    ASSERT_FALSE(keypoints.empty());
    const auto clearest =
        *std::max_element(keypoints.begin(), keypoints.end(), [](const auto& a, const auto& b) {
            return a.response < b.response;
        });
    EXPECT_GT(clearest.response, 0.0F) << "darker than around";
    EXPECT_LT((clearest.p_cam.head<2>() - at).norm(), 0.002F);
    // On a surface a blob of σ answers most where the blur's own σ is alike.
    EXPECT_GT(clearest.scale_m, 0.004F);
    EXPECT_LT(clearest.scale_m, 0.013F);
}

TEST(Sift3dDescriptors, Are2048NumbersThatTurnWithTheSurface) {
    TexturedScene scene(3);
    const Sift3dSettings settings{.smallest_scale_m = 0.004F};
    std::vector<ValuedPoint> points;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-0.06F, 0.06F), size(0.003F, 0.012F);
    std::vector<std::array<float, 3>> blobs;
    for (int i = 0; i < 40; ++i)
        blobs.push_back({place(random), place(random), size(random)});
    for (int v = -80; v <= 80; ++v)
        for (int u = -80; u <= 80; ++u) {
            const float x = 0.001F * static_cast<float>(u), y = 0.001F * static_cast<float>(v);
            float value = 0.9F;
            for (const auto& [bx, by, sigma] : blobs)
                value -=
                    0.3F *
                    std::exp(-0.5F * ((x - bx) * (x - bx) + (y - by) * (y - by)) / (sigma * sigma));
            points.push_back({{x, y, 1.0F + 2.0F * x * x}, value});
        }
    const Eigen::Isometry3f T =
        Eigen::Translation3f(0.1F, -0.05F, 0.2F) *
        Eigen::AngleAxisf(0.7F, Eigen::Vector3f(0.2F, 0.3F, 1.0F).normalized());
    auto moved = points;
    for (auto& point : moved)
        point.p_cam = T * point.p_cam;

    const auto spots = find_sift3d(points, settings);
    ASSERT_GT(spots.descriptors.size(), 10U);
    for (std::size_t i = 0; i < spots.descriptors.size(); ++i) {
        const auto numbers = spots.descriptors.of(i);
        ASSERT_EQ(numbers.size(), 2048U);
        double squares = 0.0;
        for (const float number : numbers)
            squares += number * number;
        EXPECT_NEAR(squares, 1.0, 1e-3);
    }
    const auto pose = sift3d_pose(spots, Eigen::Vector3d::Zero(), find_sift3d(moved, settings), 6);
    ASSERT_TRUE(pose);
    EXPECT_GT(pose->fit.inliers, 10);
    EXPECT_LT((pose->fit.T_cam_obj.matrix() - T.matrix().cast<double>()).norm(), 0.03);
}

TEST(Sift3d, PoorCloudsGiveNoSpots) {
    const ValuedPoint one{{0.1F, 0.2F, 1.0F}, 0.5F};
    const ValuedPoint nan{{kNaN, 0.2F, 1.0F}, 0.5F};
    const ValuedPoint far{{1e30F, 0.0F, 1.0F}, 0.5F};
    ValuedPoint no_value = one;
    no_value.value = kNaN;
    for (const std::vector<ValuedPoint>& points :
         {std::vector<ValuedPoint>{},
          {one},
          {nan, nan, far, no_value},
          std::vector<ValuedPoint>(100'000, one)}) {
        const auto spots = find_sift3d(points, {});
        EXPECT_TRUE(spots.keypoints.empty());
        EXPECT_EQ(spots.descriptors.size(), 0U);
        EXPECT_FALSE(sift3d_pose(spots, Eigen::Vector3d::Zero(), spots, 6));
    }
    EXPECT_EQ(voxelise(std::vector{one, nan, far, one}, 0.01F).size(), 1U);
}

TEST(Sift3d, RefusesSettingsByName) {
    const auto field = [](const Sift3dTrackSettings& settings) {
        const std::vector<ObjectSpec> objects{{"box", settings}};
        const auto trackers = make_trackers(RgbdCamera{}, objects);
        EXPECT_FALSE(trackers);
        return trackers ? std::string() : trackers.error().field;
    };
    EXPECT_EQ(field({.box = PictureBox{600, 0, 100, 100}}), "objects[0].box");
    for (const double scale : {0.0, -1.0, 1.0, static_cast<double>(kNaN)})
        EXPECT_EQ(field({.scale_m = scale}), "objects[0].scale_m");
    EXPECT_EQ(field({.fewest_spots = 0}), "objects[0].fewest_spots");
}

}  // namespace
}  // namespace kinectlab
