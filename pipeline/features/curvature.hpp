#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"

namespace kinectlab {

/// A point of a surface with its principal curvatures, camera frame.
struct CurvedPoint {
    Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();     ///< unit, towards the camera
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, along the smaller |curvature|
    double k1 = 0.0, k2 = 0.0;  ///< 1/m, k1 >= k2; negative where the surface bends away
    double sigma_k = 0.0;       ///< standard uncertainty of both, 1/m

    /// How curved at all, Koenderink's curvedness, 1/m.
    [[nodiscard]] double curvedness() const;
    /// S = 1/2 - 1/π atan((k1 + k2)/(k1 - k2)): 0 a cup, 1/4 a rut, 1/2 a saddle, 3/4 a ridge, 1 a
    /// cap (Chen & Bhanu 2007; the paper's equation 6). A plane has none: 1/2 is returned.
    [[nodiscard]] double shape_index() const;
};

/// By the signs of Gaussian and mean curvature (Besl & Jain 1988), zero where the noise hides them.
enum class SurfaceType : std::uint8_t { flat, peak, ridge, saddle, rut, pit };
inline constexpr int kSurfaceTypes = 6;
[[nodiscard]] SurfaceType surface_type(const CurvedPoint& point);

/// Curvature at a pixel from the quadratic surface through its neighbours within `radius_m`:
/// least squares in disparity, in which planes are linear and the noise is the same everywhere;
/// those further than 2.5 times the scatter from the surface are trimmed once. Nothing where the
/// pixel has no reading, or less than a third of its neighbours lie on its surface.
[[nodiscard]] std::optional<CurvedPoint> curved_point(
    std::span<const std::uint16_t> depth,
    const Pinhole& camera,
    const DisparityScale& scale,
    int column,
    int row,
    double radius_m
);

}  // namespace kinectlab
