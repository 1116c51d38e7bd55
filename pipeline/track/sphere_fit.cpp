#include "pipeline/track/sphere_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "pipeline/track/sphere_linearise.hpp"

namespace kinectlab {
namespace {

constexpr int kMostPixels = 16384;   // more would not be felt in the result: every 2nd, 3rd, …
constexpr double kMargin = 1.3;      // of the radius: the window shows what surrounds the sphere
constexpr double kRing = 1.1;        // of the radius: what lies beyond is not the sphere
constexpr double kRimAtFirst = 0.5;  // px inside the outline: what is farther out is left out
constexpr double kRimSigmas = 3.0;   // of the centre across the rays, once it is known
constexpr int kChoices = 3;          // of the pixels: each knows the rim better, which tells most
constexpr double kMinCosine = 0.25;  // of the incidence of rays that tell whether it is a sphere
constexpr int kMaxIterations = 12;
constexpr double kSettled_m = 5e-6;  // a smaller step changes nothing that the noise would show
constexpr double kStillMoving_m = 1e-3;
constexpr double kFirstGateSigmas = 40.0, kLastGateSigmas = 6.0;
constexpr double kLongestStep = 0.3;  // of the radius
constexpr int kFewestPixels = 24;
constexpr int kBlock = 10;        // px: a Kinect correlates over 9
constexpr double kFading = 0.97;  // of what earlier pictures told about the noise
constexpr double kMostLateralPx = 2.0;

}  // namespace

/// Normal equations of one step: JᵀWJ, JᵀWe, and the sums that tell how good the fit is.
struct SphereFitter::Equations {
    Eigen::Matrix4d information = Eigen::Matrix4d::Identity();
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    double pixels = 0.0;   // those that count, in parts where their residuals are large
    double squares = 0.0;  // of weighted residuals, steps²
};

SphereFitter::SphereFitter(const RgbdCamera& camera) : camera_(camera.depth), scale_(camera) {
    const auto room = static_cast<std::size_t>(2 * kMostPixels);
    for (auto* field : {&x_, &y_, &s_, &used_, &weight_, &residual_, &steep_})
        field->reserve(room);
    for (auto& field : slope_)
        field.reserve(room);
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
    const std::size_t padded = (s_.size() + kSphereLanes - 1) / kSphereLanes * kSphereLanes;
    for (auto* field : {&x_, &y_, &s_, &used_, &weight_, &residual_, &steep_})
        field->resize(padded, 0.0F);
    for (auto& field : slope_)
        field.resize(padded, 0.0F);
}

SphereFitter::Equations SphereFitter::equations(const Sphere& sphere, const Step& step) {
    const SpherePixels pixels{
        s_.size(),
        x_.data(),
        y_.data(),
        s_.data(),
        used_.data(),
        weight_.data(),
        residual_.data(),
        steep_.data(),
        {slope_[0].data(), slope_[1].data(), slope_[2].data(), slope_[3].data()}};
    SphereOptics at = sphere_optics(sphere, step.rim_m);
    at.per_step = static_cast<float>(1.0 / scale_.inverse_depth_step);
    at.gate = static_cast<float>(step.gate_steps);
    at.lateral = static_cast<float>(lateral());
    if (step.choose_pixels) choose_pixels(pixels, at);
    linearise_sphere(pixels, at);
    const SphereSums found = sum_equations(pixels);
    Equations sums;
    const int unknowns =
        step.fixed_radius ? 3 : 4;  // of a known radius the equation is "no change"
    std::size_t k = 0;
    for (int row = 0; row < unknowns; ++row) {
        sums.gradient[row] = found.gradient[static_cast<std::size_t>(row)];
        for (int column = 0; column <= row; ++column, ++k)
            sums.information(row, column) = sums.information(column, row) = found.products[k];
    }
    sums.pixels = found.weights + lateral() * found.steep;
    sums.squares = found.squares;
    return sums;
}

/// Gauss-Newton steps. The gate closes on the noise as the guess's own error leaves the residuals.
/// Then the pixels are chosen anew, those that surely show the sphere as well as its centre is
/// known, until a further choice would add little, and stay: pixels at the rim that come and go
/// would keep the fit from settling.
bool SphereFitter::settle(Sphere& sphere, Equations& sums, double sigma, bool fixed) {
    const double first_radius = sphere.radius;
    const double last_gate = kLastGateSigmas * sigma;
    Step way{
        kFirstGateSigmas * sigma, kRimAtFirst * sphere.centre_cam.z() / camera_.fx, true, fixed};
    int choices = kChoices;
    double step_m = 0.0;
    for (int i = 0; i < kMaxIterations; ++i) {
        sums = equations(sphere, way);
        if (sums.pixels < kFewestPixels) return false;
        const auto solver = sums.information.ldlt();
        if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
        Eigen::Vector4d step = solver.solve(sums.gradient);
        step_m = step.norm();
        if (!std::isfinite(step_m)) return false;
        if (step_m > kLongestStep * first_radius) step *= kLongestStep * first_radius / step_m;
        sphere.centre_cam += step.head<3>();
        sphere.radius += step[3];
        if (sphere.radius <= 0.0 || sphere.centre_cam.z() <= sphere.radius) return false;
        if (!way.choose_pixels && step_m < kSettled_m) break;
        way.choose_pixels = way.choose_pixels && choices > 0;
        if (way.choose_pixels && way.gate_steps == last_gate) {
            --choices;
            const Eigen::Matrix4d covariance = sigma * sigma * sums.information.inverse();
            way.rim_m = kRimSigmas * std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2.0);
        }
        way.gate_steps = std::max(last_gate, 0.25 * way.gate_steps);
    }
    return step_m < kStillMoving_m;
}

std::optional<SphereFit> SphereFitter::fit(
    std::span<const std::uint16_t> depth, const Sphere& guess, bool fixed_radius
) {
    if (guess.centre_cam.z() <= guess.radius) return std::nullopt;
    SphereFit fit;
    fit.sphere = guess;
    gather(depth, guess);
    const double sigma = scale_.sigma_at(scale_.steps_at(guess.centre_cam.z()));
    Equations sums;
    if (!settle(fit.sphere, sums, sigma, fixed_radius)) return std::nullopt;

    const double free = std::max(1.0, sums.pixels - (fixed_radius ? 3.0 : 4.0));
    const double reduced_chi2 = sums.squares / (sigma * sigma) / free;
    const double variance = sigma * sigma * std::max(1.0, reduced_chi2) * correlation_inflation();
    const Eigen::Matrix4d inverse = sums.information.inverse();
    fit.covariance = variance * inverse.topLeftCorner<3, 3>();
    fit.radius_u = fixed_radius ? 0.0 : std::sqrt(variance * inverse(3, 3));
    assess(fit, sigma);
    learn_lateral_noise(sigma);
    return fit;
}

double SphereFitter::lateral() const {
    if (lateral_.leverage == 0.0) return 0.0;
    const double most = std::pow(kMostLateralPx / (scale_.sigma_steps * camera_.fx), 2);
    return std::clamp(lateral_.excess / lateral_.leverage, 0.0, most);
}

/// Pixels of a real sensor look aside a little (Nguyen, Izadi & Lovell 2012), which shows where the
/// surface is steep: least squares of the residuals' squares, less the sensor's noise, over slope².
void SphereFitter::learn_lateral_noise(double sigma) {
    const double now = lateral();
    lateral_.excess *= kFading;
    lateral_.leverage *= kFading;
    for (std::size_t i = 0; i < weight_.size(); ++i) {
        const double weight = weight_[i] / (1.0 + now * steep_[i]);
        const double square = residual_[i] * residual_[i] / (sigma * sigma);
        lateral_.excess += weight * steep_[i] * (square - 1.0);
        lateral_.leverage += weight * steep_[i] * steep_[i];
    }
}

/// Pixels share a correlation window in a real sensor, so their errors are less than independent.
/// Whatever the window's shape, sums over blocks larger than it scatter by as much more than
/// independent errors would let them as the fitted centre does. A single picture has few blocks, so
/// the sums of earlier ones fade slowly.
double SphereFitter::correlation_inflation() {
    correlation_.of_blocks *= kFading;
    correlation_.of_pixels *= kFading;
    for (int top = 0; top < rows_; top += kBlock) {
        for (int left = 0; left < columns_; left += kBlock) {
            double sum = 0.0, squares = 0.0;
            for (int row = top; row < std::min(rows_, top + kBlock); ++row) {
                for (int column = left; column < std::min(columns_, left + kBlock); ++column) {
                    const auto i = static_cast<std::size_t>(row * columns_ + column);
                    const double error = weight_[i] * residual_[i];
                    sum += error;
                    squares += error * error;
                }
            }
            correlation_.of_blocks += sum * sum;
            correlation_.of_pixels += squares;
        }
    }
    if (correlation_.of_pixels == 0.0) return 1.0;
    return std::max(1.0, correlation_.of_blocks / correlation_.of_pixels);
}

/// How much of the sphere the picture shows, and whether the surface ends where the sphere does.
/// Follows equations() of the same sphere, whose residuals it reads.
void SphereFitter::assess(SphereFit& fit, double sigma) const {
    const Sphere& sphere = fit.sphere;
    const SphereOptics at = sphere_optics(sphere, 0.0);
    const double r = sphere.radius, z = sphere.centre_cam.z();
    const auto inside = static_cast<float>(std::sqrt(1.0 - kMinCosine * kMinCosine) * r);
    const auto ring = static_cast<float>(kRing * r), margin = static_cast<float>(kMargin * r);
    // Disparities of what may surround the sphere and is neither behind nor far before it.
    const auto behind = static_cast<float>(scale_.steps_at(z + 0.5 * r));
    const auto before = static_cast<float>(scale_.steps_at(std::max(0.1 * z, z - 2.0 * r)));
    const auto gate = static_cast<float>(kLastGateSigmas * sigma);
    int covered = 0, read = 0, inliers = 0, around = 0, alone = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows_ * columns_); ++i) {
        const float x = x_[i], y = y_[i], s = s_[i];
        const float d2 = x * x + y * y + 1.0F;
        if (root2_of(x, y, d2, inside, at) > 0.0F) {
            ++covered;
            if (s == 0.0F) continue;
            ++read;
            if (std::abs(residual_[i]) > gate) continue;
            ++inliers;
            squares += residual_[i] * residual_[i];
        } else if (root2_of(x, y, d2, ring, at) < 0.0F && root2_of(x, y, d2, margin, at) > 0.0F) {
            ++around;
            if (s < behind || s > before) ++alone;
        }
    }
    fit.quality.points = inliers * stride_ * stride_;
    fit.quality.inlier_share = read > 0 ? static_cast<double>(inliers) / read : 0.0;
    fit.quality.rms_steps = inliers > 0 ? std::sqrt(squares / inliers) : 0.0;
    fit.visible_share = covered > 0 ? static_cast<double>(inliers) / covered : 0.0;
    fit.alone_share = around > 0 ? static_cast<double>(alone) / around : 1.0;
}

}  // namespace kinectlab
