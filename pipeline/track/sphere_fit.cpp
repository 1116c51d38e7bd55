#include "pipeline/track/sphere_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace kinectlab {
namespace {

constexpr int kMostPixels = 4096;  // more would not be felt in the result: a grid of every 2nd, …
constexpr double kMargin = 1.4;    // of the radius: the window shows what surrounds the sphere
constexpr double kMinCosine = 0.25;  // rays that graze more see flying pixels and the background
constexpr int kMaxIterations = 10;
constexpr double kSettled_m = 2e-6;  // a smaller step changes nothing that the noise would show
constexpr double kStillMoving_m = 1e-3;
constexpr double kFirstGateSigmas = 40.0, kLastGateSigmas = 6.0;
constexpr int kFewestPixels = 24;

using Vector4d = Eigen::Vector4d;

}  // namespace

/// Normal equations of one step: JᵀWJ, JᵀWe, and the sums that tell how good the fit is.
struct SphereFitter::Equations {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Vector4d gradient = Vector4d::Zero();
    double weights = 0.0;
    double squares = 0.0;  // of weighted residuals, steps²
    int pixels = 0;
};

SphereFitter::SphereFitter(const RgbdCamera& camera) : camera_(camera.depth), scale_(camera) {
    for (auto* field : {&x_, &y_, &s_})
        field->reserve(2 * kMostPixels);
}

/// Copies the window around the sphere out of the picture, as rays and disparities.
void SphereFitter::gather(std::span<const std::uint16_t> depth, const Sphere& sphere) {
    const double nearest = std::max(0.05, sphere.centre_cam.z() - sphere.radius);
    const double reach = kMargin * sphere.radius / nearest;
    const Eigen::Vector2d middle = camera_.project(sphere.centre_cam);
    const auto bound = [](double value, int end) {
        return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(end)));
    };
    const int left = bound(middle.x() - reach * camera_.fx, camera_.width);
    const int right = bound(middle.x() + reach * camera_.fx + 1.0, camera_.width);
    const int top = bound(middle.y() - reach * camera_.fy, camera_.height);
    const int bottom = bound(middle.y() + reach * camera_.fy + 1.0, camera_.height);

    const double area = static_cast<double>(right - left) * (bottom - top);
    stride_ = std::max(1, static_cast<int>(std::ceil(std::sqrt(area / kMostPixels))));
    columns_ = (right - left + stride_ - 1) / stride_;
    rows_ = (bottom - top + stride_ - 1) / stride_;
    for (auto* field : {&x_, &y_, &s_})
        field->clear();
    for (int v = top; v < bottom; v += stride_) {
        const auto y = static_cast<float>((v - camera_.cy) / camera_.fy);
        const auto* row = depth.data() + static_cast<std::ptrdiff_t>(v) * camera_.width;
        for (int u = left; u < right; u += stride_) {
            x_.push_back(static_cast<float>((u - camera_.cx) / camera_.fx));
            y_.push_back(y);
            s_.push_back(row[u] == 0 ? 0.0F : static_cast<float>(scale_.steps(row[u])));
        }
    }
}

SphereFitter::Equations SphereFitter::accumulate(
    const Sphere& sphere, double gate_steps, bool fixed
) const {
    Equations sums;
    const double per_step = 1.0 / scale_.inverse_depth_step;
    for (std::size_t i = 0; i < s_.size(); ++i) {
        if (s_[i] == 0.0F) continue;
        const Eigen::Vector3d ray(x_[i], y_[i], 1.0);
        const RayHit hit = meet(ray, sphere);
        if (!hit.hits || hit.root < kMinCosine * sphere.radius * ray.norm()) continue;
        const double residual = s_[i] - hit.w * per_step;
        if (std::abs(residual) >= gate_steps) continue;
        // Tukey's weight: full for noise, none for what is not the sphere.
        const double off = residual / gate_steps;
        const double weight = (1.0 - off * off) * (1.0 - off * off);
        // From the implicit equation of meet(): dw/dc = (w d - w² c)/root, dw/dr = w² r/root.
        Vector4d slope;
        slope.head<3>() = hit.w * (ray - hit.w * sphere.centre_cam);
        slope[3] = fixed ? 0.0 : hit.w * hit.w * sphere.radius;
        slope *= per_step / hit.root;
        sums.information.selfadjointView<Eigen::Lower>().rankUpdate(slope, weight);
        sums.gradient += weight * residual * slope;
        sums.weights += weight;
        sums.squares += weight * residual * residual;
        ++sums.pixels;
    }
    if (fixed) sums.information(3, 3) = 1.0;  // the radius's equation is "no change"
    return sums;
}

std::optional<SphereFit> SphereFitter::fit(
    std::span<const std::uint16_t> depth, const Sphere& guess, bool fixed_radius
) {
    Sphere sphere = guess;
    gather(depth, sphere);
    const double sigma = scale_.sigma_at(scale_.steps_at(std::max(0.05, guess.centre_cam.z())));
    double gate = kFirstGateSigmas * sigma;
    Equations sums;
    double step_m = 0.0;
    for (int i = 0; i < kMaxIterations; ++i) {
        sums = accumulate(sphere, gate, fixed_radius);
        if (sums.pixels < kFewestPixels) return std::nullopt;
        const auto solver = sums.information.selfadjointView<Eigen::Lower>().ldlt();
        if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
        Vector4d step = solver.solve(sums.gradient);
        step_m = step.norm();
        if (!std::isfinite(step_m)) return std::nullopt;
        if (step_m > 0.3 * guess.radius) step *= 0.3 * guess.radius / step_m;
        sphere.centre_cam += step.head<3>();
        sphere.radius += step[3];
        if (sphere.radius <= 0.0 || sphere.centre_cam.z() <= sphere.radius) return std::nullopt;
        const bool narrow = gate <= 1.01 * kLastGateSigmas * sigma;
        if (narrow && step_m < kSettled_m) break;
        // The gate closes on the noise as the guess's own error leaves the residuals.
        gate = std::max(kLastGateSigmas * sigma, 0.4 * gate);
    }
    if (step_m > kStillMoving_m) return std::nullopt;

    const double parameters = fixed_radius ? 3.0 : 4.0;
    const double reduced_chi2 =
        sums.squares / (sigma * sigma) / std::max(1.0, sums.weights - parameters);
    const Eigen::Matrix4d inverse =
        sums.information.selfadjointView<Eigen::Lower>().ldlt().solve(Eigen::Matrix4d::Identity());
    const double inflation = std::max(1.0, reduced_chi2) * correlation_inflation(sphere);
    SphereFit fit;
    fit.sphere = sphere;
    fit.covariance = inverse.topLeftCorner<3, 3>() * sigma * sigma * inflation;
    fit.radius_u = fixed_radius ? 0.0 : sigma * std::sqrt(inverse(3, 3) * inflation);
    assess(depth, fit);
    return fit;
}

/// Pixels share a correlation window in a real sensor, so their errors are less than independent:
/// with a correlation ρ between neighbours that falls off geometrically, a mean over many pixels
/// has (1+ρ)/(1-ρ) times the variance, in each direction of the picture.
double SphereFitter::correlation_inflation(const Sphere& sphere) const {
    const double gate = kLastGateSigmas * scale_.sigma_at(scale_.steps_at(sphere.centre_cam.z()));
    const auto residual = [&](std::size_t i) {
        const Eigen::Vector3d ray(x_[i], y_[i], 1.0);
        const RayHit hit = meet(ray, sphere);
        const bool graze = !hit.hits || hit.root < 2.0 * kMinCosine * sphere.radius * ray.norm();
        const double e = s_[i] - hit.w / scale_.inverse_depth_step;
        return graze || s_[i] == 0.0F || std::abs(e) > gate ? 0.0 : e;
    };
    double squares = 0.0, beside = 0.0, below = 0.0;
    int used = 0;
    for (int row = 0; row + 1 < rows_; ++row) {
        for (int column = 0; column + 1 < columns_; ++column) {
            const auto i = static_cast<std::size_t>(row * columns_ + column);
            const double e = residual(i);
            if (e == 0.0) continue;
            squares += e * e;
            beside += e * residual(i + 1);
            below += e * residual(i + static_cast<std::size_t>(columns_));
            ++used;
        }
    }
    if (used < kFewestPixels || squares == 0.0) return 1.0;
    const auto factor = [&](double products) {
        // What chance alone makes of independent errors is not correlation.
        const double rho = products / squares - 2.0 / std::sqrt(used);
        const double clamped = std::clamp(rho, 0.0, 0.8);
        return (1.0 + clamped) / (1.0 - clamped);
    };
    return factor(beside) * factor(below);
}

/// How much of the sphere the picture shows, and whether the surface ends where the sphere does.
void SphereFitter::assess(std::span<const std::uint16_t> depth, SphereFit& fit) const {
    (void)depth;
    const Sphere& sphere = fit.sphere;
    const double sigma = scale_.sigma_at(scale_.steps_at(sphere.centre_cam.z()));
    const double r2 = sphere.radius * sphere.radius;
    int covered = 0, read = 0, inliers = 0, around = 0, alone = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < s_.size(); ++i) {
        const Eigen::Vector3d ray(x_[i], y_[i], 1.0);
        const double miss2 = ray.cross(sphere.centre_cam).squaredNorm() / ray.squaredNorm();
        if (miss2 < (1.0 - kMinCosine * kMinCosine) * r2) {
            ++covered;
            if (s_[i] == 0.0F) continue;
            ++read;
            const double e = s_[i] - meet(ray, sphere).w / scale_.inverse_depth_step;
            if (std::abs(e) > kLastGateSigmas * sigma) continue;
            ++inliers;
            squares += e * e;
        } else if (miss2 > 1.15 * 1.15 * r2 && miss2 < kMargin * kMargin * r2) {
            ++around;
            const double z = s_[i] == 0.0F ? 0.0 : scale_.metres(s_[i]);
            const double behind = z - sphere.centre_cam.z();
            if (z == 0.0 || behind > 0.5 * sphere.radius || behind < -2.0 * sphere.radius) ++alone;
        }
    }
    fit.quality.points = inliers * stride_ * stride_;
    fit.quality.inlier_share = read > 0 ? static_cast<double>(inliers) / read : 0.0;
    fit.quality.rms_steps = inliers > 0 ? std::sqrt(squares / inliers) : 0.0;
    fit.visible_share = covered > 0 ? static_cast<double>(inliers) / covered : 0.0;
    fit.alone_share = around > 0 ? static_cast<double>(alone) / around : 1.0;
}

}  // namespace kinectlab
