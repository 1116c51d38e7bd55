#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/track/object_spec.hpp"
#include "pipeline/track/sphere_fit.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// Finds one whole sphere that stands alone in the pixels of a thing that moved. Keeps its buffers.
/// Not thread-safe.
class SphereDetector {
public:
    explicit SphereDetector(const RgbdCamera& camera);

    /// Spheres that were found already: pixels on them are no other's.
    struct Taken {
        std::span<const Sphere> claimed, passed_by;
    };

    /// Nothing where the pixels show no sphere of the settings' radius, or not surely.
    [[nodiscard]] std::optional<SphereFit> find(
        const RgbdFrame& frame,
        MovedPixels pixels,
        const SphereSettings& settings,
        const Taken& taken
    );

    /// A sphere of known radius that was found, with its radius free. Nothing where the picture
    /// says too little about it: far or small, where noise pulls a free radius aside by more than
    /// it scatters.
    [[nodiscard]] std::optional<SphereFit> with_free_radius(
        const RgbdFrame& frame, const Sphere& known
    );

    /// Of a pixel with a reading, camera frame, m.
    [[nodiscard]] Eigen::Vector3d point(const RgbdFrame& frame, std::uint32_t pixel) const;

private:
    MovedPixels without_taken(const RgbdFrame& frame, MovedPixels pixels, const Taken& taken);
    [[nodiscard]] bool is_sphere(const SphereFit& fit, const SphereSettings& settings) const;

    RgbdCamera camera_;
    DisparityScale scale_;
    SphereFitter fitter_;
    std::vector<std::uint32_t> rest_;
};

}  // namespace kinectlab
