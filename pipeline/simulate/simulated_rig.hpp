#pragma once

#include <cstdint>
#include <memory>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/simulate/apparatus.hpp"
#include "pipeline/simulate/noise_model.hpp"
#include "pipeline/simulate/scene.hpp"

namespace kinectlab::simulate {

struct RigSettings {
    ApparatusSettings apparatus;
    NoiseModel noise = NoiseModel::kinect;
    std::uint64_t seed =
        1;  ///< the same seed gives the same frames, whichever of them are rendered
    CameraPlacement camera;
    bool with_colour = true;  ///< false leaves RgbdFrame::rgb empty and saves its time
    TimeNs start = 0;         ///< the rig's time 0 in UTC
};

constexpr double kFrameRateHz = 30.0;

/// An apparatus, its laboratory and the Kinect that watches it. Time is what advance_to()
/// says, never a clock. Not thread-safe: one thread owns a rig.
class SimulatedRig {
public:
    [[nodiscard]] static Result<SimulatedRig> create(const RigSettings& settings);

    SimulatedRig(SimulatedRig&&) noexcept;
    SimulatedRig& operator=(SimulatedRig&&) noexcept;
    ~SimulatedRig();

    /// Takes effect at the rig's present time.
    [[nodiscard]] Result<void> apply(const Command& command);

    /// Seconds since the rig was switched on; times before the last one are ignored.
    void advance_to(double t_s);

    /// Turns the colour camera on for good; costs the time of rendering the room once.
    void turn_on_colour();

    /// What the Kinect sees now. Index = time x 30 Hz, t = t_colour = start + time; depth in mm.
    /// The frame's buffers are reused.
    void render(RgbdFrame& frame);

    [[nodiscard]] Truth truth() const;
    [[nodiscard]] const Apparatus& apparatus() const;
    [[nodiscard]] const RgbdCamera& camera() const;
    [[nodiscard]] const Eigen::Isometry3d& T_lab_cam() const;  ///< of the depth camera

private:
    struct State;
    explicit SimulatedRig(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::simulate
