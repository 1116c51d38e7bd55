#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/features/match.hpp"
#include "pipeline/features/sift3d.hpp"
#include "pipeline/track/rigid_fit.hpp"

namespace kinectlab {

/// The spots of a cloud with their descriptions.
struct Sift3dSpots {
    std::vector<Keypoint3d> keypoints;
    Descriptors3d descriptors;
};

/// No spots for an empty cloud or a surface without contrast.
[[nodiscard]] Sift3dSpots find_sift3d(
    std::span<const ValuedPoint> points, const Sift3dSettings& settings
);

/// A pose and how many matches were offered to it.
struct Sift3dPose {
    RigidFit fit;
    int matches = 0;
};

/// The pose of an object whose spots were found at first in `model` (their places relative to
/// `origin_cam`) among those of a scene. Nothing where fewer than `fewest` agree.
[[nodiscard]] std::optional<Sift3dPose> sift3d_pose(
    const Sift3dSpots& model,
    const Eigen::Vector3d& origin_cam,
    const Sift3dSpots& scene,
    int fewest
);

}  // namespace kinectlab
