#pragma once

#include <array>
#include <optional>

#include "pipeline/analysis/collision_search.hpp"
#include "pipeline/analysis/residual_fit.hpp"

namespace kinectlab {

/// Where a collision's parameters stand in the fit's vector.
namespace collision {
inline constexpr Eigen::Index kTime = 0;    ///< of the impact, s
inline constexpr Eigen::Index kDrag = 1;    ///< of both balls, 1/s
inline constexpr Eigen::Index kSlope = 2;   ///< two: common horizontal acceleration, m/s²
inline constexpr Eigen::Index kCount = 22;  ///< with nine for each ball

/// Of ball 0 or 1: where it is at the impact (m), its velocity just before and just after (m/s).
[[nodiscard]] Eigen::Vector3d centre(const Eigen::VectorXd& parameters, std::size_t ball);
[[nodiscard]] Eigen::Vector3d before(const Eigen::VectorXd& parameters, std::size_t ball);
[[nodiscard]] Eigen::Vector3d after(const Eigen::VectorXd& parameters, std::size_t ball);

/// Position of a ball at a time (s): uniform but for drag and slope, bent at the impact.
[[nodiscard]] Eigen::Vector3d position(
    const Eigen::VectorXd& parameters, std::size_t ball, double t
);
}  // namespace collision

struct CollisionPriors {
    double drag_u = 0.0;   ///< 1/s, of no drag; 0: there is none
    double slope_u = 0.0;  ///< m/s², of a level table; 0: it is level
};

/// Fits both balls' paths at once, with one moment of impact, at which neither jumps.
/// Errors (bad_data) as fit_residuals; none that an impact of find_impact brings about.
[[nodiscard]] Result<ResidualFit> fit_collision(
    const std::array<std::span<const PositionSample>, 2>& balls,
    const Impact& impact,
    const CollisionPriors& priors
);

}  // namespace kinectlab
