#pragma once

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"

namespace kinectlab::bench {

/// The Cramér-Rao bound: no unbiased estimate of a sphere's centre from one depth picture can have
/// a smaller covariance. Found from the true sphere alone, by numerical differences of the
/// disparity that every pixel's ray meets; shares nothing with the tracker. Independent Gaussian
/// errors of `sigma_steps` in disparity, radius known. m².
[[nodiscard]] Eigen::Matrix3d centre_bound(
    const RgbdCamera& camera, const Eigen::Vector3d& centre_cam, double radius_m
);

}  // namespace kinectlab::bench
