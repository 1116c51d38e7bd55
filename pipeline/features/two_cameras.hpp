#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"

namespace kinectlab {

/// A point of the colour picture found again in the depth picture.
struct TracedPoint {
    Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();  ///< m, depth camera's frame
    std::uint32_t pixel = 0;                          ///< of the depth picture, nearest to it
    double sigma_z_m = 0.0;  ///< of the depth, m; neighbours' shared noise reckoned with
};

/// Leads from the depth picture to the colour picture and back through the real geometry of two
/// cameras that do not look through the same hole. Holds values only; safe to share.
class TwoCameras {
public:
    explicit TwoCameras(const RgbdCamera& camera);

    /// Where a point of the depth camera's frame is seen by the colour camera, px.
    [[nodiscard]] Eigen::Vector2d colour_pixel(const Eigen::Vector3d& p_cam) const {
        return camera_.colour.project(camera_.T_colour_depth * p_cam);
    }

    /// For each of `count` depth pixels of row v from column u on: row-major index of the colour
    /// pixel that shows the same point, -1 where there is no reading or it lies outside of the
    /// colour picture. What hides behind something nearer is not found out here.
    void colour_indices(const std::uint16_t* row, int u, int v, int count, std::int32_t* indices)
        const;

    /// Goes back from a colour pixel (sub-pixel, px) to the surface that it shows: walks the ray
    /// through the depth picture from near to far, takes the first reading that the colour camera
    /// sees within a pixel of it, and refines the point where the ray meets the plane through the
    /// readings around. Nothing where the ray meets no reading, or an edge between near and far,
    /// where nobody knows to which side the colour belongs.
    [[nodiscard]] std::optional<TracedPoint> trace(
        std::span<const std::uint16_t> depth, double u, double v
    ) const;

private:
    [[nodiscard]] std::optional<TracedPoint> meet_surface(
        std::span<const std::uint16_t> depth,
        const Eigen::Vector3d& ray,
        const Eigen::Vector3d& first_guess
    ) const;

    RgbdCamera camera_;
    DisparityScale scale_;
    Eigen::Vector3d origin_;    ///< of the colour camera in the depth camera's frame, m
    Eigen::Matrix3d R_depth_;   ///< turns rays of the colour camera into the depth camera's frame
    double inverse_far_ = 0.0;  ///< 1/m, where the walk along a ray ends
    double inverse_near_ = 0.0;
};

}  // namespace kinectlab
