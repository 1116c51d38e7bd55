#pragma once

#include <string>

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab {

/// Pictures that every analysis can draw of its fit. Directions are unit vectors of the lab frame.

/// Measured and fitted coordinate along `direction` from `origin`, against time since the first
/// sample.
[[nodiscard]] Plot position_plot(
    const ObjectFit& fit,
    const Eigen::Vector3d& origin,
    const Eigen::Vector3d& direction,
    const std::string& name = "position",
    const std::string& title = "Position against time",
    const std::string& symbol = "x"
);

/// The residuals' three coordinates in millimetres against time.
[[nodiscard]] Plot residual_plot(const ObjectFit& fit, const std::string& name = "residuals");

/// Measured and fitted path in the plane that two directions span.
[[nodiscard]] Plot path_plot(
    const ObjectFit& fit,
    const Eigen::Vector3d& origin,
    const Eigen::Vector3d& right,
    const Eigen::Vector3d& up,
    const std::string& right_symbol = "x",
    const std::string& up_symbol = "z"
);

/// Velocity against position along a direction: of the fit as a line, of the measured trajectory as
/// points. `trajectory` is what the fit was made of.
[[nodiscard]] Plot phase_plot(
    const ObjectFit& fit,
    const Trajectory& trajectory,
    const Eigen::Vector3d& origin,
    const Eigen::Vector3d& direction,
    const std::string& symbol = "x"
);

/// Where a metre stands for a thousand pixels: the labels say so.
void label_pixels(std::vector<Plot>& plots);

}  // namespace kinectlab
