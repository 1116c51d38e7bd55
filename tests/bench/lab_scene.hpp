#pragma once

#include <string>
#include <vector>

#include "pipeline/core/cloud.hpp"
#include "pipeline/simulate/noise_model.hpp"

namespace kinectlab::bench {

/// The simulated laboratory as a Kinect sees it once, and as it is.
struct LabScene {
    RgbdCamera camera;
    RgbdFrame frame;
    Cloud seen;
    Cloud exact;                               ///< the same pixels without noise, to a micrometre
    std::vector<Eigen::Vector3f> true_normal;  ///< of each pixel, towards the camera; 0 = nothing
    Eigen::Vector3d bob_cam = Eigen::Vector3d::Zero();
    double bob_radius_m = 0.05;

    /// Whether the reading is one of the surface that the pixel truly shows: within five standard
    /// deviations of it. Flying pixels and holes are not.
    [[nodiscard]] bool on_surface(std::size_t i) const;
    /// Distance of a point to the true surface at pixel i, along its normal, m.
    [[nodiscard]] double off_surface(std::size_t i, float x, float y, float z) const;
};

/// `t_s` after the bob was let go at 20°; the bob is at rest if negative.
[[nodiscard]] LabScene lab_scene(
    simulate::NoiseModel noise, double t_s = -1.0, std::uint64_t seed = 1
);

/// Organised clouds of real sensors from the shared data, if they are there: environment
/// KINECTLAB_SHARED_DATA, or ../shared/data.
struct RealCloud {
    std::string name;
    Cloud cloud;
};
[[nodiscard]] std::vector<RealCloud> real_clouds(std::size_t most);

}  // namespace kinectlab::bench
