#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab::bench {

/// What anybody would put together for a coloured thing: cvtColor to HSV, inRange, the biggest of
/// connectedComponentsWithStats, each of its colour pixels' depth through a registered picture,
/// the centroid with Eigen. One thread.
class OpenCvColourPlace {
public:
    /// OpenCV's own units: hue 0 to 179, saturation and value 0 to 255.
    OpenCvColourPlace(
        const RgbdCamera& camera, const std::array<int, 3>& low, const std::array<int, 3>& high
    );

    [[nodiscard]] std::optional<Eigen::Vector3d> place(const RgbdFrame& frame) const;

private:
    RgbdCamera camera_;
    std::array<int, 3> low_, high_;
};

}  // namespace kinectlab::bench
