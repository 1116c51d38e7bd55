#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/core/mesh.hpp"

namespace kinectlab::bench {

/// PCL's KLDAdaptiveParticleFilterOMPTracker as in its tutorial, on one thread: 600 particles,
/// nearest-pair coherence by distance, every second pixel of each second row in the region around
/// the object, the reference a cloud of what the first frame shows of it.
class ParticleFilter {
public:
    /// The object's surface as points about its centre, and where it is at first.
    ParticleFilter(
        const RgbdCamera& camera,
        const std::vector<Eigen::Vector3f>& surface,
        const Eigen::Isometry3d& T_cam_obj
    );
    ~ParticleFilter();
    ParticleFilter(const ParticleFilter&) = delete;
    ParticleFilter& operator=(const ParticleFilter&) = delete;

    [[nodiscard]] Eigen::Isometry3d track(const RgbdFrame& frame);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::bench
