#pragma once

#include <span>
#include <vector>

#include "pipeline/features/sift3d.hpp"

namespace kinectlab::bench {

/// The Point Cloud Library's SIFTKeypoint on the same points, scales and contrast.
[[nodiscard]] std::vector<Eigen::Vector3f> pcl_sift3d_keypoints(
    std::span<const ValuedPoint> points, const Sift3dSettings& settings
);

}  // namespace kinectlab::bench
