#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"

namespace kinectlab {

/// How far the centroid of a patch of pixels errs because its outline does. Each of 16 sectors
/// about the centroid moves for itself. How much is measured by what its weights change from frame
/// to frame once the patch's own motion is taken out; half a pixel over a depth sensor's
/// correlation window is expected before anything is seen. Keeps its buffers, which many patches
/// share. Not thread-safe.
class OutlineError {
public:
    explicit OutlineError(const Pinhole& lens);

    struct Pixel {
        std::uint32_t pixel = 0;  ///< row-major
        float weight = 1.0F;      ///< belongs to the patch by so much, above 0
        float z = 0.0F;           ///< m
    };
    /// What is known about one patch; a plain value.
    struct Memory {
        Eigen::Vector3d centroid_cam = Eigen::Vector3d::Zero();  ///< in the frame before
        Eigen::Matrix3d measured = Eigen::Matrix3d::Zero();      ///< mean over `comparisons`
        double comparisons = 0.0;
    };

    /// Covariance of the centroid of the pixels `now`, whose weights add up to `mass`; `before` is
    /// empty where the patch was out of sight.
    [[nodiscard]] Eigen::Matrix3d covariance(
        Memory& memory,
        std::span<const Pixel> before,
        std::span<const Pixel> now,
        const Eigen::Vector3d& centroid_cam,
        double mass
    );

private:
    [[nodiscard]] Eigen::Matrix3d expected(
        std::span<const Pixel> now, const Eigen::Vector3d& centroid_cam, double mass
    ) const;
    [[nodiscard]] Eigen::Matrix3d changed(
        std::span<const Pixel> before,
        std::span<const Pixel> now,
        const Eigen::Vector3d& from_cam,
        const Eigen::Vector3d& to_cam,
        double mass
    ) const;
    [[nodiscard]] Eigen::Vector3d off(const Pixel& one, const Eigen::Vector3d& centroid_cam) const;

    Pinhole lens_;
    std::vector<float> now_, before_;  // weights, a value a pixel; all 0 between calls
};

/// The covariance of a centroid under the readings' noise: neighbours share a part of it. `squares`
/// is the sum of the squared weights; the ray through the centroid has `sigma_share` of its length
/// as noise.
[[nodiscard]] Eigen::Matrix3d readings_error(
    const Eigen::Vector3d& centroid_cam, double sigma_share, double squares, double mass
);

}  // namespace kinectlab
