#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab {

/// Pixel → point of the surface that it shows, and how well that is known.
class SurfacePoints {
public:
    explicit SurfacePoints(const RgbdCamera& camera) : camera_(camera), scale_(camera) {}

    /// m, camera frame; `pixel` is row-major and has a reading.
    [[nodiscard]] Eigen::Vector3d at(const RgbdFrame& frame, std::uint32_t pixel) const {
        const auto column = static_cast<int>(pixel) % camera_.depth.width;
        const auto row = static_cast<int>(pixel) / camera_.depth.width;
        return camera_.depth.ray(column, row) * (camera_.depth_unit_m * frame.depth[pixel]);
    }
    /// Standard deviation along z of a reading at z metres.
    [[nodiscard]] double sigma_z(double z) const {
        const double s = scale_.steps_at(z);
        return z * scale_.sigma_at(s) / s;
    }
    [[nodiscard]] const Pinhole& lens() const { return camera_.depth; }

private:
    RgbdCamera camera_;
    DisparityScale scale_;
};

/// Sums over the pixels that show one thing. Sums of parts add up to that of the whole.
struct SurfaceMoments {
    int points = 0;
    double area_m2 = 0.0;  ///< seen, across the line of sight
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0.0;

    void add(const SurfacePoints& surface, const Eigen::Vector3d& p_cam) {
        const double z = p_cam.z();
        ++points;
        area_m2 += z * z / (surface.lens().fx * surface.lens().fy);
        sum += p_cam;
        squares += p_cam.squaredNorm();
    }
    void add(const SurfaceMoments& part) {
        points += part.points;
        area_m2 += part.area_m2;
        sum += part.sum;
        squares += part.squares;
    }
    [[nodiscard]] Eigen::Vector3d centroid() const { return sum / points; }
    /// RMS distance of the points from their centroid, m.
    [[nodiscard]] double extent() const {
        return std::sqrt(std::max(0.0, squares / points - centroid().squaredNorm()));
    }
};

}  // namespace kinectlab
