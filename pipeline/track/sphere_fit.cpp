#include "pipeline/track/sphere_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr int kMostPixels = 16384;  // more would not be felt in the result: a grid of every 2nd, …
constexpr double kMargin = 1.3;     // of the radius: the window shows what surrounds the sphere
constexpr double kRing = 1.1;       // of the radius: what lies beyond is not the sphere
constexpr double kMinCosine = 0.25;  // rays that graze more see flying pixels and the background
constexpr int kMaxIterations = 10;
constexpr double kSettled_m = 2e-6;  // a smaller step changes nothing that the noise would show
constexpr double kStillMoving_m = 1e-3;
constexpr double kFirstGateSigmas = 40.0, kLastGateSigmas = 6.0;
constexpr double kLongestStep = 0.3;  // of the radius
constexpr int kFewestPixels = 24;
constexpr int kBlock = 10;  // px: a Kinect correlates over 9

constexpr std::size_t kLanes = 8;  // sums run side by side, for the vector units

/// The window's arrays, their size a multiple of kLanes.
struct Pixels {
    std::size_t size;
    const float *x, *y, *s;
    float *used, *weight, *residual;
    std::array<float*, 4> slope;
};

/// A linearisation point in single precision.
struct Point {
    float cx, cy, cz, radius;
    float power;  ///< c·c - r²
    float per_step, gate;
};

/// The square of meet()'s root from the cross product, r² d·d - |d x c|², which loses no digits in
/// single precision.
inline float root2_of(float x, float y, float d2, const Point& at) {
    const float across_x = y * at.cz - at.cy;
    const float across_y = at.cx - x * at.cz;
    const float across_z = x * at.cy - y * at.cx;
    const float across2 = across_x * across_x + across_y * across_y + across_z * across_z;
    return at.radius * at.radius * d2 - across2;
}

/// Which pixels the fit rests on: those with a reading whose rays do not graze.
KINECTLAB_HOT_LOOP void choose(const Pixels& pixels, const Point& point) {
    const Point at = point;
    const float *xs = pixels.x, *ys = pixels.y, *ss = pixels.s;
    float* used = pixels.used;
    constexpr auto kLeast2 = static_cast<float>(kMinCosine * kMinCosine);
    const float r2 = at.radius * at.radius;
#pragma GCC ivdep  // the arrays are all different ones
    for (std::size_t i = 0; i < pixels.size; ++i) {
        const float x = xs[i], y = ys[i];
        const float d2 = x * x + y * y + 1.0F;
        const float read = std::min(ss[i], 1.0F);  // nothing is as far as one step, 350 m
        used[i] = root2_of(x, y, d2, at) >= kLeast2 * r2 * d2 ? read : 0.0F;
    }
}

/// Residual, Tukey's weight and the slopes of every pixel. From the implicit equation of meet():
/// dw/dc = (w d - w² c)/root and dw/dr = w² r/root.
KINECTLAB_HOT_LOOP void linearise(const Pixels& pixels, const Point& point) {
    const Point at = point;
    const float* xs = pixels.x;
    const float* ys = pixels.y;
    const float* ss = pixels.s;
    float* weights = pixels.weight;
    float* residuals = pixels.residual;
    float* by_x = pixels.slope[0];
    float* by_y = pixels.slope[1];
    float* by_z = pixels.slope[2];
    float* by_r = pixels.slope[3];
    const float* used = pixels.used;
    constexpr auto kLeast2 = static_cast<float>(0.25 * kMinCosine * kMinCosine);
    const float r2 = at.radius * at.radius;
#pragma GCC ivdep  // the arrays are all different ones
    for (std::size_t i = 0; i < pixels.size; ++i) {
        const float x = xs[i], y = ys[i];
        const float d2 = x * x + y * y + 1.0F;
        const float root = std::sqrt(std::max(root2_of(x, y, d2, at), kLeast2 * r2 * d2));
        const float w = (x * at.cx + y * at.cy + at.cz + root) / at.power;
        const float residual = ss[i] - w * at.per_step;
        const float off = residual / at.gate;
        const float tukey = std::max(0.0F, 1.0F - off * off);
        weights[i] = used[i] * tukey * tukey;
        residuals[i] = residual;
        const float scale = w * at.per_step / root;
        by_x[i] = scale * (x - w * at.cx);
        by_y[i] = scale * (y - w * at.cy);
        by_z[i] = scale * (1.0F - w * at.cz);
        by_r[i] = scale * w * at.radius;
    }
}

/// Sum of weight·a·b.
KINECTLAB_HOT_LOOP double weighted_sum(
    const float* __restrict weight,
    const float* __restrict a,
    const float* __restrict b,
    std::size_t size
) {
    std::array<float, kLanes> sums{};
    for (std::size_t i = 0; i < size; i += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            sums[lane] += weight[i + lane] * a[i + lane] * b[i + lane];
    double total = 0.0;
    for (const float sum : sums)
        total += sum;
    return total;
}

}  // namespace

/// Normal equations of one step: JᵀWJ, JᵀWe, and the sums that tell how good the fit is.
struct SphereFitter::Equations {
    Eigen::Matrix4d information = Eigen::Matrix4d::Identity();
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    double weights = 0.0;
    double squares = 0.0;  // of weighted residuals, steps²
};

SphereFitter::SphereFitter(const RgbdCamera& camera) : camera_(camera.depth), scale_(camera) {
    const auto room = static_cast<std::size_t>(2 * kMostPixels);
    for (auto* field : {&x_, &y_, &s_, &used_, &weight_, &residual_})
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
    const std::size_t padded = (s_.size() + kLanes - 1) / kLanes * kLanes;
    for (auto* field : {&x_, &y_, &s_, &used_, &weight_, &residual_})
        field->resize(padded, 0.0F);
    for (auto& field : slope_)
        field.resize(padded, 0.0F);
}

SphereFitter::Equations SphereFitter::equations(const Sphere& sphere, const Step& step) {
    const Eigen::Vector3f c = sphere.centre_cam.cast<float>();
    const double power = sphere.centre_cam.squaredNorm() - sphere.radius * sphere.radius;
    const Pixels pixels{
        s_.size(),
        x_.data(),
        y_.data(),
        s_.data(),
        used_.data(),
        weight_.data(),
        residual_.data(),
        {slope_[0].data(), slope_[1].data(), slope_[2].data(), slope_[3].data()}};
    const Point at{
        c.x(),
        c.y(),
        c.z(),
        static_cast<float>(sphere.radius),
        static_cast<float>(power),
        static_cast<float>(1.0 / scale_.inverse_depth_step),
        static_cast<float>(step.gate_steps)};
    if (step.choose_pixels) choose(pixels, at);
    linearise(pixels, at);
    const auto sum = [this](const std::vector<float>& a, const std::vector<float>& b) {
        return weighted_sum(weight_.data(), a.data(), b.data(), s_.size());
    };
    Equations sums;
    const int unknowns =
        step.fixed_radius ? 3 : 4;  // of a known radius the equation is "no change"
    for (int row = 0; row < unknowns; ++row) {
        const auto& by_row = slope_[static_cast<std::size_t>(row)];
        sums.gradient[row] = sum(by_row, residual_);
        for (int column = 0; column <= row; ++column) {
            const double value = sum(by_row, slope_[static_cast<std::size_t>(column)]);
            sums.information(row, column) = sums.information(column, row) = value;
        }
    }
    sums.weights = std::accumulate(weight_.begin(), weight_.end(), 0.0);
    sums.squares = sum(residual_, residual_);
    return sums;
}

/// Gauss-Newton steps. The gate closes on the noise as the guess's own error leaves the residuals;
/// from then on the pixels stay the same.
bool SphereFitter::settle(Sphere& sphere, Equations& sums, double sigma, bool fixed) {
    const double first_radius = sphere.radius;
    const double last_gate = kLastGateSigmas * sigma;
    Step way{kFirstGateSigmas * sigma, true, fixed};
    double step_m = 0.0;
    for (int i = 0; i < kMaxIterations; ++i) {
        sums = equations(sphere, way);
        if (sums.weights < kFewestPixels) return false;
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
        // Pixels at the rim that come and go would keep the fit from settling.
        way.choose_pixels = way.gate_steps > last_gate;
        way.gate_steps = std::max(last_gate, 0.4 * way.gate_steps);
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

    const double free = std::max(1.0, sums.weights - (fixed_radius ? 3.0 : 4.0));
    const double reduced_chi2 = sums.squares / (sigma * sigma) / free;
    const double variance = sigma * sigma * std::max(1.0, reduced_chi2) * correlation_inflation();
    const Eigen::Matrix4d inverse = sums.information.inverse();
    fit.covariance = variance * inverse.topLeftCorner<3, 3>();
    fit.radius_u = fixed_radius ? 0.0 : std::sqrt(variance * inverse(3, 3));
    assess(fit, sigma);
    return fit;
}

/// Pixels share a correlation window in a real sensor, so their errors are less than independent.
/// Whatever the window's shape, sums over blocks larger than it scatter by as much more than
/// independent errors would let them as the fitted centre does. A single picture has few blocks, so
/// the sums of earlier ones fade slowly.
double SphereFitter::correlation_inflation() {
    constexpr double kFading = 0.97;
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
void SphereFitter::assess(SphereFit& fit, double sigma) const {
    const Sphere& sphere = fit.sphere;
    const double r2 = sphere.radius * sphere.radius;
    int covered = 0, read = 0, inliers = 0, around = 0, alone = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows_ * columns_); ++i) {
        const Eigen::Vector3d ray(x_[i], y_[i], 1.0);
        const double miss2 = ray.cross(sphere.centre_cam).squaredNorm() / ray.squaredNorm();
        if (miss2 < (1.0 - kMinCosine * kMinCosine) * r2) {
            ++covered;
            if (s_[i] == 0.0F) continue;
            ++read;
            const double e = s_[i] - scale_.steps_at(1.0 / meet(ray, sphere).w);
            if (std::abs(e) > kLastGateSigmas * sigma) continue;
            ++inliers;
            squares += e * e;
        } else if (miss2 > kRing * kRing * r2 && miss2 < kMargin * kMargin * r2) {
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
