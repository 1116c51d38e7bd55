#pragma once

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"

namespace kinectlab::bench {

/// The Cramér-Rao bound: no unbiased estimate of a sphere's centre from one depth picture can have
/// a smaller covariance. Found from the true sphere alone, by numerical differences of the
/// disparity that every pixel's ray meets; shares nothing with the tracker. Independent Gaussian
/// errors of `sigma_steps` in disparity, radius known. m².
///
/// The bound holds for pixels that show the sphere whatever its centre is, as far as the noise
/// leaves that open; at the very rim the slope is infinite and a bound is not defined. So `rim_m`
/// is taken off the outline: rays that pass nearer to it do not count. 0 takes every pixel that is
/// hit.
[[nodiscard]] Eigen::Matrix3d centre_bound(
    const RgbdCamera& camera, const Eigen::Vector3d& centre_cam, double radius_m, double rim_m
);

/// The bound with a rim of three of its own standard deviations across the viewing direction.
[[nodiscard]] Eigen::Matrix3d regular_centre_bound(
    const RgbdCamera& camera, const Eigen::Vector3d& centre_cam, double radius_m
);

}  // namespace kinectlab::bench
