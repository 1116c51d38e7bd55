#include "pipeline/track/sift3d_model.hpp"

#include <cmath>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr float kRatio = 0.9F;        // of the nearest to the second nearest description
constexpr double kSpotShare = 0.25;   // σ of a spot's place in its scale, both looks together
constexpr double kFewestShare = 0.2;  // of the matches must agree

/// Distances of unit vectors.
KINECTLAB_HOT_LOOP void distances_to_all(
    const float* one, const float* others, std::size_t count, float* out
) {
    constexpr std::size_t kLanes = 32;
    for (std::size_t at = 0; at < count; ++at) {
        const float* other = others + at * kSift3dLength;
        float sums[kLanes] = {};
        for (std::size_t i = 0; i < kSift3dLength; i += kLanes)
            for (std::size_t lane = 0; lane < kLanes; ++lane)
                sums[lane] += one[i + lane] * other[i + lane];
        float sum = 0.0F;
        for (const float part : sums)
            sum += part;
        out[at] = std::sqrt(std::max(0.0F, 2.0F - 2.0F * sum));
    }
}

}  // namespace

Sift3dSpots find_sift3d(std::span<const ValuedPoint> points, const Sift3dSettings& settings) {
    Sift3dSpots spots;
    const auto octaves = surface_scale_space(points, settings);
    spots.keypoints = sift3d_keypoints(octaves, settings);
    spots.descriptors = sift3d_descriptors(octaves, spots.keypoints);
    return spots;
}

std::optional<Sift3dPose> sift3d_pose(
    const Sift3dSpots& model,
    const Eigen::Vector3d& origin_cam,
    const Sift3dSpots& scene,
    int fewest
) {
    const auto spot = [](const Sift3dSpots& spots, std::uint32_t descriptor) -> const Keypoint3d& {
        return spots.keypoints[spots.descriptors.keypoint[descriptor]];
    };
    std::vector<Match> matches;
    match_nearest(
        model.descriptors.size(),
        scene.descriptors.size(),
        kRatio,
        [&](std::uint32_t m, float* out) {
            distances_to_all(
                model.descriptors.of(m).data(),
                scene.descriptors.numbers.data(),
                scene.descriptors.size(),
                out
            );
        },
        [&](std::uint32_t s, std::uint32_t t) {
            const auto &a = spot(scene, s), &b = spot(scene, t);
            return (a.p_cam - b.p_cam).norm() < a.scale_m + b.scale_m;
        },
        matches
    );
    std::vector<PointPair> pairs;
    for (const auto& match : matches) {
        const Keypoint3d &then = spot(model, match.model), &now = spot(scene, match.scene);
        const double sigma = kSpotShare * std::hypot(then.scale_m, now.scale_m);
        pairs.push_back(
            {then.p_cam.cast<double>() - origin_cam,
             now.p_cam.cast<double>(),
             sigma * sigma * Eigen::Matrix3d::Identity()}
        );
    }
    RigidFitSettings settings;
    settings.fewest_inliers = fewest;
    settings.fewest_share = kFewestShare;
    settings.gate_sigmas = 3.0;
    auto fit = fit_rigid(pairs, settings);
    if (!fit) return std::nullopt;
    return Sift3dPose{std::move(*fit), static_cast<int>(pairs.size())};
}

}  // namespace kinectlab
