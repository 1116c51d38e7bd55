#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/track_sample.hpp"

namespace kinectlab {

/// Cuts a mask over the depth picture into pieces of continuous surface. Keeps its buffers.
class SurfacePieces {
public:
    explicit SurfacePieces(const RgbdCamera& camera);

    /// Pieces of at least `fewest` pixels, biggest first. `mask` has a byte a pixel and is cleared
    /// on the way. Neighbours belong together if their depths differ by no more than noise and a
    /// steep surface explain. Spans are valid until the next call.
    [[nodiscard]] std::span<const std::span<const std::uint32_t>> cut(
        std::span<const std::uint16_t> depth, std::span<std::uint8_t> mask, std::size_t fewest
    );

private:
    [[nodiscard]] bool continuous(std::uint16_t a, std::uint16_t b) const;

    int width_;
    int height_;
    DisparityScale scale_;
    std::vector<std::uint32_t> pixels_;
    std::vector<std::span<const std::uint32_t>> pieces_;
};

/// First and second moments of a piece of visible surface.
struct SurfaceMoments {
    Eigen::Vector3d centroid_cam = Eigen::Vector3d::Zero();         ///< m
    Eigen::Matrix3d centroid_covariance = Eigen::Matrix3d::Zero();  ///< m²
    /// Principal axes as columns, longest first, a right-handed turn; signs are arbitrary.
    Eigen::Matrix3d axes_cam = Eigen::Matrix3d::Identity();
    Eigen::Vector3d variances = Eigen::Vector3d::Zero();        ///< along the axes, m²
    Eigen::Matrix3d turn_covariance = Eigen::Matrix3d::Zero();  ///< of the axes, rad²
    bool axes_known = false;  ///< the three are clearly of different length
};

/// Of pixels with a reading; there must be one at least. The covariances are those of the sensor's
/// noise, neighbours' shared part reckoned with, and of an outline known to half a pixel.
[[nodiscard]] SurfaceMoments surface_moments(
    std::span<const std::uint16_t> depth,
    std::span<const std::uint32_t> pixels,
    const RgbdCamera& camera
);

/// The axes with those signs that turn least from other axes.
[[nodiscard]] Eigen::Matrix3d nearest_signs(
    const Eigen::Matrix3d& axes_cam, const Eigen::Matrix3d& before_cam
);

}  // namespace kinectlab
