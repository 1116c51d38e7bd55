#pragma once

#include "pipeline/analysis/pendulum.hpp"

namespace kinectlab {

/// Where the fitted bob moves to and fro, seen from above.
struct SwingAxes {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< where it would hang still, lab frame, m
    Eigen::Vector3d along = Eigen::Vector3d::UnitX();  ///< horizontal, where the bob moves most
    Eigen::Vector3d across = Eigen::Vector3d::UnitY();
};

[[nodiscard]] SwingAxes swing_axes(const FollowedSwing& swing);

/// "amplitude": the amplitude in degrees over time, measured in each half period as the share of
/// the fitted displacement that the positions show, and the envelope that the drag law gives.
[[nodiscard]] Plot amplitude_plot(const FollowedSwing& swing, const SwingAxes& axes);

/// "period_amplitude": the time from one passage of the middle to the next but one, measured from
/// how late the positions of a half period around each passage are, against its amplitude, with the
/// series 1 + θ²/16 + 11θ⁴/3072 + 173θ⁶/737280 and the exact (2/π) K(sin θ/2).
[[nodiscard]] Plot period_amplitude_plot(const FollowedSwing& swing, const SwingAxes& axes);

/// Facts that acceptance checks look at: "periods", "gap_share" of the free swing, "amplitude_deg".
[[nodiscard]] std::map<std::string, double> swing_facts(
    const FollowedSwing& swing, const std::vector<Measurement>& measurements
);

}  // namespace kinectlab
