#include "tests/bench/shape_bound.hpp"

#include <Eigen/LU>

namespace kinectlab::bench {
namespace {

using test::Solid;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Two directions across the axis, sideways first, and the axis.
Eigen::Matrix3d frame_of(const Solid& solid) {
    Eigen::Matrix3d frame;
    frame.col(2) = solid.axis;
    frame.col(0) = solid.place.cross(solid.axis).normalized();
    frame.col(1) = solid.axis.cross(frame.col(0));
    return frame;
}

/// The solid changed by one of: three shifts, two tilts about its reference point, the size.
Solid changed(Solid solid, const Eigen::Matrix3d& frame, int unknown, double delta) {
    const bool can = solid.kind == Solid::Kind::can;
    const double middle = can ? 0.5 * (solid.from + solid.to) : 0.0;
    Eigen::Vector3d reference = solid.place + middle * solid.axis;
    if (unknown < 3) reference += delta * frame.col(unknown);
    if (unknown == 3 || unknown == 4)
        solid.axis = (solid.axis + delta * frame.col(unknown - 3)).normalized();
    solid.place = reference - middle * solid.axis;
    if (unknown == 5) (solid.kind == Solid::Kind::cone ? solid.angle : solid.radius) += delta;
    return solid;
}

Solid slimmer(Solid solid, double rim_m) {
    if (solid.kind == Solid::Kind::cone) {
        const double deeper = rim_m / std::sin(solid.angle);
        solid.place += deeper * solid.axis;
        solid.from -= deeper;
        solid.to -= deeper;
    } else {
        solid.radius -= rim_m;
    }
    return solid;
}

/// Disparity in steps where the round face is entered.
std::optional<double> disparity(
    const RgbdCamera& camera, const Solid& solid, const Eigen::Vector3d& ray
) {
    const auto entry = test::enter(solid, ray);
    if (!entry || entry->face != 0) return std::nullopt;
    return 1.0 / (entry->z * camera.noise.inverse_depth_step);
}

Matrix6d covariance(const RgbdCamera& camera, const Solid& solid, double rim_m) {
    constexpr double kDelta = 1e-6;
    const Eigen::Matrix3d frame = frame_of(solid);
    const bool is[3] = {
        solid.kind == Solid::Kind::ball,
        solid.kind == Solid::Kind::can,
        solid.kind == Solid::Kind::cone};
    const std::array<bool, 6> unknown{true, true, !is[1], !is[0], !is[0], true};
    std::array<Solid, 6> plus, minus;
    for (int k = 0; k < 6; ++k) {
        plus[static_cast<std::size_t>(k)] = changed(solid, frame, k, kDelta);
        minus[static_cast<std::size_t>(k)] = changed(solid, frame, k, -kDelta);
    }
    const Solid slim = slimmer(solid, rim_m);
    Matrix6d information = Matrix6d::Zero();
    for (int v = 0; v < camera.depth.height; ++v) {
        for (int u = 0; u < camera.depth.width; ++u) {
            const Eigen::Vector3d ray = camera.depth.ray(u, v);
            if (!disparity(camera, slim, ray) || !disparity(camera, solid, ray)) continue;
            Vector6d slope = Vector6d::Zero();
            bool seen = true;
            for (std::size_t k = 0; k < 6 && seen; ++k) {
                if (!unknown[k]) continue;
                const auto more = disparity(camera, plus[k], ray);
                const auto less = disparity(camera, minus[k], ray);
                seen = more && less;
                if (seen) slope[static_cast<int>(k)] = (*more - *less) / (2.0 * kDelta);
            }
            if (seen) information += slope * slope.transpose();
        }
    }
    for (int k = 0; k < 6; ++k)
        if (!unknown[static_cast<std::size_t>(k)]) information(k, k) = 1e30;
    const double sigma = camera.noise.sigma_steps;
    return sigma * sigma * information.inverse();
}

}  // namespace

ShapeBound shape_bound(const RgbdCamera& camera, const Solid& solid) {
    double rim_m = 0.5 * solid.place.norm() / camera.depth.fx;
    // A cone is held best in the middle of what is seen, not at its apex.
    const double h = solid.kind == Solid::Kind::cone ? 0.5 * (solid.from + solid.to) : 0.0;
    Matrix6d bound;
    for (int i = 0; i < 3; ++i) {  // the rim and the bound settle at once
        bound = covariance(camera, solid, rim_m);
        const double sideways2 = bound(0, 0) + 2.0 * h * bound(0, 3) + h * h * bound(3, 3);
        rim_m = 3.0 * std::sqrt(sideways2);
    }
    return {
        std::sqrt(bound.topLeftCorner<3, 3>().trace()),
        std::sqrt(bound(3, 3) + bound(4, 4)),
        std::sqrt(bound(5, 5))};
}

}  // namespace kinectlab::bench
