#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab::bench {

/// What anybody would put together from the Point Cloud Library: PassThrough before the wall,
/// OctreePointCloudChangeDetector of 20 mm against a reference frame (its two buffers ask for that
/// anew before every frame), NormalEstimation with 50
/// neighbours, SACSegmentationFromNormals for a sphere.
class StockChain {
public:
    struct Settings {
        RgbdCamera camera;
        double cut_m = 3.0;
        double radius_m = 0.05;
    };
    StockChain(const Settings& settings, const RgbdFrame& reference);
    ~StockChain();
    StockChain(const StockChain&) = delete;
    StockChain& operator=(const StockChain&) = delete;

    /// The sphere's centre in the camera frame; nothing where no sphere was found.
    [[nodiscard]] std::optional<Eigen::Vector3d> track(const RgbdFrame& frame);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::bench
