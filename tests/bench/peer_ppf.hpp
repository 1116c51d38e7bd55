#pragma once

#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "tests/bench/oriented_points.hpp"

namespace kinectlab::bench {

/// OpenCV's point pair features (Drost et al. 2010), its surface_matching module: model and scene
/// sampled at a twentieth of the object's size, as its documentation has it for the model, and
/// pairs of every fiftieth point of the scene; the five poses with most votes are refined by its
/// ICP, the one with the least residual is taken.
class PpfDetector {
public:
    explicit PpfDetector(const OrientedPoints& model);
    ~PpfDetector();

    /// T_cam_obj; nothing where no pose was found, or the module is not installed.
    [[nodiscard]] std::optional<Eigen::Isometry3d> find(const OrientedPoints& scene);

    [[nodiscard]] static bool is_installed();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::bench
