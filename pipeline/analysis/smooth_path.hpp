#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/analysis/noise_memory.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab {

/// One measured place on the floor: x, y (m, lab) and the heading (rad, unwrapped; 0 if not seen).
struct FloorSample {
    std::size_t index = 0;  ///< in the trajectory
    double t = 0.0;         ///< s since the trajectory's first sample
    Eigen::Vector3d value;
    Eigen::Matrix3d spread;  ///< spread · spreadᵀ = covariance of the noise
};

/// The smoothed path at one sample's time: cubic through the neighbours, and how it is made of
/// them.
struct SmoothPoint {
    std::size_t first = 0;              ///< of the samples that it is made of
    std::vector<double> value_weights;  ///< value = Σ weight · sample, from `first` on
    std::vector<double> slope_weights;
    std::vector<double> bend_weights;
    Eigen::Vector3d value;
    Eigen::Vector3d slope;  ///< m/s, m/s, rad/s
    Eigen::Vector3d bend;   ///< second derivative
    Eigen::Matrix3d slope_covariance;
};

struct SmoothPath {
    std::vector<FloorSample> samples;       ///< without outliers, noise as the residuals show it
    std::vector<SmoothPoint> points;        ///< one for each sample
    std::vector<std::size_t> stretch_ends;  ///< one past the last sample of each unbroken stretch
    std::vector<NoiseMemory> memories;
    bool has_heading = false;  ///< from the object's own x axis
    int outliers = 0;
    double reduced_chi2 = 0.0;

    /// Covariance of numbers that change by `gradient` (3 rows: x, y, heading; a column for each
    /// number) with each sample from `first` on.
    [[nodiscard]] Eigen::MatrixXd covariance(std::size_t first, std::vector<Jacobian3> gradient)
        const;
};

/// Local cubic regression (Cleveland 1979) with Epanechnikov's weights over `half_window_s` to both
/// sides, over twice as much to one side at the ends. Nothing reaches across a gap longer than the
/// half window; pieces too short to be smoothed are left out. How long the noise lasts comes from
/// cubics through separate windows.
/// Errors (bad_data): too few samples, samples that are no numbers.
[[nodiscard]] Result<SmoothPath> smooth_path(const Trajectory& trajectory, double half_window_s);

}  // namespace kinectlab
