#pragma once

#include <cmath>
#include <numbers>
#include <optional>

namespace kinectlab {

/// A number and how well it is known.
struct LocalGravity {
    double g = 0.0;  ///< m/s²
    double u = 0.0;  ///< m/s²
};

/// Gravity on the ellipsoid of WGS 84 after Somigliana (NIMA TR8350.2, eq. 4-1), m/s². The height
/// of the place and what lies under it make the uncertainty: 3e-6 m/s² for each metre, and a
/// laboratory lies below 2 km. Without a latitude: the middle between the equator and the poles.
[[nodiscard]] inline LocalGravity local_gravity(std::optional<double> latitude_deg) {
    if (!latitude_deg) return {9.806, 0.015};
    constexpr double kEquator = 9.7803253359;
    constexpr double kFormula = 0.00193185265241;
    constexpr double kEccentricitySq = 0.00669437999014;
    const double s = std::sin(*latitude_deg * std::numbers::pi / 180.0);
    return {kEquator * (1.0 + kFormula * s * s) / std::sqrt(1.0 - kEccentricitySq * s * s), 0.0015};
}

}  // namespace kinectlab
