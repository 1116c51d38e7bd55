#include "pipeline/track/plane_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "pipeline/track/shape_quality.hpp"

namespace kinectlab {
namespace {

constexpr double kSettled = 1e-2;  // of a standard deviation: a smaller step changes nothing

/// The plane m·p = 1, m = n/h.
struct SettledPlane {
    Eigen::Vector3d m;
    Eigen::Matrix3d information;  // about m, for σ = 1
    PlaneSums sums;               // of the last step
};

/// s = m·d/step is linear, so that only the outliers' weights ask for repetition.
std::optional<SettledPlane> settle_plane(
    ShapePixels& pixels, const Shape& guess, double sigma, double per_step
) {
    const double offset = guess.axis.dot(guess.point);
    if (!(std::abs(offset) > 1e-6)) return std::nullopt;
    SettledPlane plane{guess.axis / offset, Eigen::Matrix3d::Zero(), {}};
    const double last_gate = kLastGateSigmas * sigma;
    double gate = kFirstGateSigmas * sigma;
    bool settled = false;
    for (int i = 0; i < kMostFitSteps && !settled; ++i) {
        const Eigen::Vector3f at = (plane.m * per_step).cast<float>();
        plane.sums =
            linearise_plane(pixels.flat(), {at.x(), at.y(), at.z()}, static_cast<float>(gate));
        const PlaneSums& sums = plane.sums;
        if (sums.weights < 0.5 * kFewestFitPixels) return std::nullopt;
        plane.information << sums.xx, sums.xy, sums.x, sums.xy, sums.yy, sums.y, sums.x, sums.y,
            sums.weights;
        plane.information *= per_step * per_step;
        const auto solver = plane.information.ldlt();
        if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
        const Eigen::Vector3d gradient = per_step * Eigen::Vector3d(sums.rx, sums.ry, sums.r);
        const Eigen::Vector3d step = solver.solve(gradient);
        if (!step.allFinite()) return std::nullopt;
        plane.m += step;
        settled = gate <= last_gate && std::sqrt(std::abs(step.dot(gradient))) < kSettled * sigma;
        gate = std::max(last_gate, 0.5 * gate);
    }
    if (!(plane.m.norm() > 1e-6)) return std::nullopt;
    return plane;
}

/// Pixels on one line determine no plane: its smallest axis in the picture would be noise.
bool is_wide(const PlaneSums& sums, double half_px) {
    const double x = sums.x / sums.weights, y = sums.y / sums.weights;
    const double var_x = sums.xx / sums.weights - x * x;
    const double var_y = sums.yy / sums.weights - y * y;
    const double cov = sums.xy / sums.weights - x * y;
    return var_x * var_y - cov * cov > half_px * half_px * (var_x + var_y);
}

/// Of the point where the ray d meets the plane, and of the turn, from that of m. The point moves
/// along its ray by -Z² δm·d, which is a shift of the plane along its normal of n·d as much; and
/// δn = (1 - n nᵀ) δm/|m| is a turn n x δn.
Matrix6d covariance_of(
    const Eigen::Vector3d& m,
    const Eigen::Vector3d& d,
    const Eigen::Matrix3d& of_m,
    double outline_m
) {
    const double w = m.dot(d), length = m.norm();
    const Eigen::Vector3d normal = m / length;  // n·p = 1/|m| > 0: away from the camera
    const double z2 = 1.0 / (w * w);
    Eigen::Matrix<double, 6, 3> by_m;
    by_m.topRows<3>() = normal * (-z2 * normal.dot(d)) * d.transpose();
    Eigen::Matrix3d cross;
    cross << 0.0, -normal.z(), normal.y(), normal.z(), 0.0, -normal.x(), -normal.y(), normal.x(),
        0.0;
    by_m.bottomRows<3>() = cross / length;
    Matrix6d covariance = by_m * of_m * by_m.transpose();
    // Along the plane only the outline tells where its middle is, and nothing how it is turned.
    const Eigen::Matrix3d along = normal * normal.transpose();
    covariance.topLeftCorner<3, 3>() +=
        outline_m * outline_m * (Eigen::Matrix3d::Identity() - along);
    covariance.bottomRightCorner<3, 3>() += kAnyAngle * along;
    return covariance;
}

}  // namespace

std::optional<ShapeFit> fit_plane(
    ShapePixels& pixels,
    const Pinhole& camera,
    const DisparityScale& scale,
    const Shape& guess,
    CorrelatedNoise& noise
) {
    const double sigma = pixels.mean_sigma(scale);
    const auto plane = settle_plane(pixels, guess, sigma, 1.0 / scale.inverse_depth_step);
    if (!plane || !is_wide(plane->sums, 0.5 / camera.fx)) return std::nullopt;
    const PlaneSums& sums = plane->sums;
    const Eigen::Vector3d d(sums.x / sums.weights, sums.y / sums.weights, 1.0);
    const double w = plane->m.dot(d);
    if (!(w > 0.0)) return std::nullopt;

    ShapeFit fit;
    fit.shape.kind = ShapeKind::plane;
    fit.shape.point = d / w;
    fit.shape.axis = -plane->m.normalized();
    const double variance = sigma * sigma * noise.inflation(pixels, sigma, 3.0);
    fit.covariance = covariance_of(
        plane->m, d, variance * plane->information.inverse(), 0.5 * fit.shape.point.z() / camera.fx
    );
    const ShapeQuality found = judge_fit(pixels, kLastGateSigmas * sigma);
    fit.quality = found.quality;
    fit.cost = found.cost;
    return fit;
}

double misfit_plane(ShapePixels& pixels, const DisparityScale& scale, const Shape& guess) {
    const double sigma = pixels.mean_sigma(scale);
    const auto plane = settle_plane(pixels, guess, sigma, 1.0 / scale.inverse_depth_step);
    return plane ? judge_fit(pixels, kLastGateSigmas * sigma).cost : 1.0;
}

}  // namespace kinectlab
