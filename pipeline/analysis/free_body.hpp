#pragma once

#include <array>
#include <optional>

#include "pipeline/analysis/attitude_fit.hpp"

namespace kinectlab {

/// Where a free body's parameters stand in the fit's vector. Its start is the first sample's time.
namespace free_body {
inline constexpr Eigen::Index kTurn = 0;   ///< three: from the first measured attitude, lab, rad
inline constexpr Eigen::Index kRate = 3;   ///< three: angular velocity at the start, lab, rad/s
inline constexpr Eigen::Index kMount = 6;  ///< three: principal axes against the object's, rad
inline constexpr Eigen::Index kShape = 9;  ///< three sizes in m, or logarithms of moments' ratios
inline constexpr Eigen::Index kCount = 12;

/// Principal moments of inertia as shares of the first, of a uniform box with these edges.
[[nodiscard]] Eigen::Vector3d box_moments(const Eigen::Vector3d& size_m);
}  // namespace free_body

struct FreeBodySettings {
    std::optional<Eigen::Vector3d> size_m;  ///< of a uniform box; none: the ratios are fitted
    double size_u_m = 0.0;                  ///< of each edge
    double mount_u_rad = 0.0;  ///< of the principal axes' directions in the object's frame
    bool alike = false;        ///< a box without marks: half turns about its axes look the same
};

struct FreeBody {
    ResidualFit fit;
    Eigen::Quaterniond first = Eigen::Quaterniond::Identity();  ///< that kTurn counts from
    bool box = false;  ///< kShape holds sizes, not logarithms

    /// Ratios of the principal moments, the first is 1.
    [[nodiscard]] Eigen::Vector3d moments(const Eigen::VectorXd& parameters) const;
    /// Angular momentum at the start in the lab frame and twice the rotational energy, both over
    /// the first principal moment.
    [[nodiscard]] Eigen::Vector3d momentum(const Eigen::VectorXd& parameters) const;
    [[nodiscard]] double energy(const Eigen::VectorXd& parameters) const;
    /// Attitudes and angular velocities in the lab frame at times since the samples' origin, s.
    void motion(
        const Eigen::VectorXd& parameters,
        double start_s,
        std::span<const double> t,
        std::span<Eigen::Quaterniond> q,
        std::span<Eigen::Vector3d> rate
    ) const;
};

/// Fits Euler's equations of the torque-free body to the attitudes, growing from the first half
/// second to all of them.
/// Errors (bad_data): as fit_residuals; a body that does not turn, or that turns more than a third
/// of the way to ambiguity from frame to frame.
[[nodiscard]] Result<FreeBody> fit_free_body(
    std::span<const AttitudeSample> samples, const FreeBodySettings& settings
);

}  // namespace kinectlab
