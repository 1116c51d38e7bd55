#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab::bench {

/// What stands in many tutorials: depth difference to a background picture, OpenCV's morphology and
/// connectedComponentsWithStats, each component's centroid, and names given by the nearest
/// centroid of the frame before, or within `patience` frames; no prediction. One thread.
class OpenCvNearestNames {
public:
    OpenCvNearestNames(const RgbdCamera& camera, std::vector<std::uint16_t> background);

    struct Named {
        std::uint32_t name = 0;
        Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();
    };
    [[nodiscard]] std::span<const Named> follow(const RgbdFrame& frame);

private:
    struct Known {
        Named thing;
        int unseen = 0;
    };
    [[nodiscard]] std::vector<Eigen::Vector3d> components(const RgbdFrame& frame) const;

    RgbdCamera camera_;
    std::vector<std::uint16_t> background_;
    std::vector<Known> known_;
    std::vector<Named> seen_;
    std::uint32_t next_ = 1;
};

}  // namespace kinectlab::bench
