#include "pipeline/track/shape_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "pipeline/track/shape_linearise.hpp"

namespace kinectlab {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kMostPixels = 32768;  // of more every 2nd, 3rd, … is used
constexpr std::size_t kFewestPixels = 24;
constexpr int kMaxIterations = 24;
constexpr double kFirstGateSigmas = 24.0, kLastGateSigmas = 6.0;
constexpr double kRimAtFirst = 0.7;  // px inside the outline: what is farther out is left out
constexpr double kMinRim = 0.02;     // px
constexpr double kRoughRim = 2.0;    // times σ²: the sensor's rims are worse than its faces
constexpr int kChoices = 2;          // of the pixels at the last gate
constexpr double kRimSigmas = 3.0;   // of the shape across the rays, once it is known
constexpr double kEndMarginPx = 1.5;
constexpr double kLongestStep = 0.3;  // of the radius; rad for angles
constexpr double kMaxSize_m = 2.0, kMaxAngle = 1.4, kMinAngle = 0.03;
constexpr double kSettled = 1e-2;  // of a standard deviation: a smaller step changes nothing
constexpr double kStillMoving = 1.0;
constexpr std::uint32_t kBlock = 10;  // px: a Kinect correlates over 9
constexpr double kFading = 0.97;      // of what earlier fits told about the noise
constexpr double kAnyAngle = std::numbers::pi * std::numbers::pi / 3.0;  // rad², uniform

/// Across the axis e1 goes sideways as the camera sees it and e2 towards the camera.
Eigen::Matrix3d frame_of(const Shape& shape) {
    const Eigen::Vector3d a =
        shape.kind == ShapeKind::sphere ? Eigen::Vector3d::UnitY() : shape.axis;
    Eigen::Vector3d sideways = shape.point.cross(a);
    if (sideways.norm() < 1e-3 * shape.point.norm()) sideways = a.unitOrthogonal();
    Eigen::Matrix3d R_cam_shape;
    R_cam_shape.col(0) = sideways.normalized();
    R_cam_shape.col(1) = a.cross(R_cam_shape.col(0));
    R_cam_shape.col(2) = a;
    return R_cam_shape;
}

/// Which of t1, t2, t3, ω1, ω2, size a kind has.
std::array<bool, 6> unknowns_of(ShapeKind kind, bool fixed_size) {
    switch (kind) {
        case ShapeKind::sphere:
            return {true, true, true, false, false, !fixed_size};
        case ShapeKind::cylinder:
            return {true, true, false, true, true, !fixed_size};
        case ShapeKind::cone:
            return {true, true, true, true, true, !fixed_size};
        case ShapeKind::plane:
            break;
    }
    return {true, true, true, false, false, false};
}

}  // namespace

struct ShapeFitter::Way {
    double gate_steps = 0.0;
    double rim_m = 0.0;
    double low = -1e6, high = 1e6;
    bool choose = true;
    std::array<bool, 6> active{};
    Eigen::Matrix3d R_cam_shape = Eigen::Matrix3d::Identity();
};

struct ShapeFitter::Equations {
    Matrix6d information = Matrix6d::Identity();
    Vector6d gradient = Vector6d::Zero();
    double pixels = 0.0;
};

ShapeFitter::ShapeFitter(const RgbdCamera& camera)
    : camera_(camera.depth),
      scale_(camera),
      block_columns_(camera.depth.width / static_cast<int>(kBlock) + 1),
      block_rows_(camera.depth.height / static_cast<int>(kBlock) + 1) {
    const auto blocks = static_cast<std::size_t>(block_columns_ * block_rows_);
    block_sum_.resize(blocks);
    block_squares_.resize(blocks);
}

void ShapeFitter::gather(const DisparityImage& image, std::span<const std::uint32_t> pixels) {
    for (auto* field : {&x_, &y_, &s_})
        field->clear();
    pixel_.clear();
    const std::size_t stride = (pixels.size() + kMostPixels - 1) / kMostPixels;
    const auto width = static_cast<std::uint32_t>(camera_.width);
    const double per_fx = 1.0 / camera_.fx, per_fy = 1.0 / camera_.fy;
    for (std::size_t k = 0; k < pixels.size(); k += stride) {
        const float s = image.at(pixels[k]);
        if (s == 0.0F) continue;
        x_.push_back(static_cast<float>((pixels[k] % width - camera_.cx) * per_fx));
        y_.push_back(static_cast<float>((pixels[k] / width - camera_.cy) * per_fy));
        s_.push_back(s);
        pixel_.push_back(pixels[k]);
    }
    offered_ = s_.size();
    const std::size_t padded = (offered_ + kFitLanes - 1) / kFitLanes * kFitLanes;
    for (auto* field : {&x_, &y_, &s_, &used_, &weight_, &residual_, &height_})
        field->resize(padded, 0.0F);
    for (auto& field : slope_)
        field.resize(padded, 0.0F);
}

double ShapeFitter::mean_sigma() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < offered_; ++i)
        sum += s_[i];
    return scale_.sigma_at(sum / static_cast<double>(std::max<std::size_t>(1, offered_)));
}

std::optional<ShapeFit> ShapeFitter::fit(
    const DisparityImage& image,
    std::span<const std::uint32_t> pixels,
    const Shape& guess,
    bool fixed_size
) {
    if (pixels.empty() || !guess.point.allFinite() || !guess.axis.allFinite() ||
        !std::isfinite(guess.size))
        return std::nullopt;
    gather(image, pixels);
    if (offered_ < kFewestPixels) return std::nullopt;
    return guess.kind == ShapeKind::plane ? fit_plane(guess) : fit_round(guess, fixed_size);
}

void ShapeFitter::linearise(const Shape& shape, const Way& way) {
    const RoundPixels pixels{
        x_.size(),
        x_.data(),
        y_.data(),
        s_.data(),
        used_.data(),
        weight_.data(),
        residual_.data(),
        height_.data(),
        {slope_[0].data(),
         slope_[1].data(),
         slope_[2].data(),
         slope_[3].data(),
         slope_[4].data(),
         slope_[5].data()}};
    const double per_step = 1.0 / scale_.inverse_depth_step;
    if (way.choose) {
        // Rays that meet a slimmer shape meet this one surely.
        Shape slim = shape;
        const bool cone = shape.kind == ShapeKind::cone;
        const double deeper = cone ? way.rim_m / std::sin(shape.size) : 0.0;
        slim.point += deeper * shape.axis;
        if (!cone) slim.size = std::max(0.5 * shape.size, shape.size - way.rim_m);
        const RoundOptics optics = round_optics(slim, shape, way.R_cam_shape, per_step);
        choose_pixels(pixels, optics, way.low - deeper, way.high - deeper);
    }
    linearise_round(pixels, round_optics(shape, shape, way.R_cam_shape, per_step), way.gate_steps);
}

ShapeFitter::Equations ShapeFitter::equations(const Way& way) const {
    Equations sums;
    const NormalSums found = sum_equations(
        {slope_[0].data(),
         slope_[1].data(),
         slope_[2].data(),
         slope_[3].data(),
         slope_[4].data(),
         slope_[5].data()},
        weight_.data(),
        residual_.data(),
        x_.size()
    );
    std::size_t k = 0;
    for (int row = 0; row < 6; ++row)
        for (int column = 0; column <= row; ++column, ++k) {
            const bool both = way.active[static_cast<std::size_t>(row)] &&
                              way.active[static_cast<std::size_t>(column)];
            if (both)
                sums.information(row, column) = sums.information(column, row) = found.products[k];
        }
    for (int row = 0; row < 6; ++row)
        if (way.active[static_cast<std::size_t>(row)])
            sums.gradient[row] = found.gradient[static_cast<std::size_t>(row)];
    sums.pixels = found.weights;
    return sums;
}

/// Gauss-Newton steps while the gate closes. A step is measured in standard deviations of what it
/// changes.
bool ShapeFitter::settle(Shape& shape, Way& way, Equations& sums) {
    const double sigma = mean_sigma();
    const double last_gate = kLastGateSigmas * sigma;
    double length = 0.0;
    int at_last_gate = 0;
    for (int i = 0; i < kMaxIterations; ++i) {
        way.R_cam_shape = frame_of(shape);
        linearise(shape, way);
        sums = equations(way);
        if (sums.pixels < static_cast<double>(kFewestPixels) / 2.0) return false;
        const auto solver = sums.information.ldlt();
        if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
        Vector6d step = solver.solve(sums.gradient);
        if (!step.allFinite()) return false;
        length = std::sqrt(std::max(0.0, step.dot(sums.gradient))) / sigma;
        const double reach = shape.kind == ShapeKind::cone ? 0.05 : shape.size;
        const double shift = step.head<3>().norm() / (kLongestStep * reach);
        const double turn = step.segment<2>(3).norm() / kLongestStep;
        const double growth = std::abs(step[5]) / (kLongestStep * shape.size);
        step /= std::max({1.0, shift, turn, growth});
        shape.point += way.R_cam_shape * step.head<3>();
        if (shape.kind != ShapeKind::sphere)
            shape.axis = (shape.axis + way.R_cam_shape * Eigen::Vector3d(step[4], -step[3], 0.0))
                             .normalized();
        shape.size += step[5];
        const bool cone = shape.kind == ShapeKind::cone;
        if (!(shape.size > (cone ? kMinAngle : 1e-3)) ||
            !(shape.size < (cone ? kMaxAngle : kMaxSize_m)))
            return false;
        const bool last = way.gate_steps <= last_gate;
        if (last && length < kSettled) return true;
        // Pixels at the rim that come and go would keep the fit from settling.
        if (last && ++at_last_gate >= kChoices) way.choose = false;
        way.gate_steps = std::max(last_gate, 0.5 * way.gate_steps);
    }
    return length < kStillMoving;
}

/// Where along the axis the shape is seen: heights at which most rays that meet it read it. Beyond
/// are lids, tables and hands, some of whose pixels lie near the surface by chance and would pull.
void ShapeFitter::find_ends(const Shape& shape, double sigma, Way& way) {
    constexpr std::size_t kBins = 96;
    const auto gate = static_cast<float>(3.0 * sigma);
    float least = 1e9F, most = -1e9F;
    for (std::size_t i = 0; i < offered_; ++i) {
        if (weight_[i] <= 0.0F) continue;
        least = std::min(least, height_[i]);
        most = std::max(most, height_[i]);
    }
    if (!(most > least)) return;
    std::array<int, kBins> met{}, on{};
    const float per_bin = static_cast<float>(kBins) / (most - least);
    for (std::size_t i = 0; i < offered_; ++i) {
        if (used_[i] == 0.0F || height_[i] < least || height_[i] > most) continue;
        const auto bin =
            std::min(kBins - 1, static_cast<std::size_t>((height_[i] - least) * per_bin));
        ++met[bin];
        if (std::abs(residual_[i]) < gate) ++on[bin];
    }
    auto sorted = on;
    std::nth_element(sorted.begin(), sorted.begin() + kBins / 2, sorted.end());
    const int few = sorted[kBins / 2] / 4;
    const auto good = [&](std::size_t bin) {
        return on[bin] > few && 10 * on[bin] >= 7 * met[bin];
    };
    std::size_t best_from = 0, best_to = 0, from = 0, gap = 0;
    bool inside = false;
    std::size_t last_good = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        if (good(bin)) {
            if (!inside) from = bin;
            inside = true;
            last_good = bin;
            gap = 0;
        } else if (inside && ++gap > kBins / 8) {
            inside = false;
        }
        if (inside && last_good + 1 - from > best_to - best_from)
            best_from = from, best_to = last_good + 1;
    }
    if (best_to == best_from) return;
    const double sine = shape.point.normalized().cross(shape.axis).norm();
    const double margin = kEndMarginPx * shape.point.z() / camera_.fx / std::max(0.3, sine);
    const double low = least + static_cast<double>(best_from) / per_bin + margin;
    const double high = least + static_cast<double>(best_to) / per_bin - margin;
    if (high - low < 2.0 * margin) return;
    way.low = low;
    way.high = high;
}

/// Whether the pixels nearest to the outline err no more than the others. They tell most of a size,
/// but a real sensor's look aside a little, which shows where the surface is steep.
bool ShapeFitter::rim_is_sound(const Shape& shape, const Way& way, double wide_m, double sigma) {
    Way one = way;
    linearise(shape, one);
    narrow_ = used_;
    one.rim_m = wide_m;
    linearise(shape, one);
    const double gate = kLastGateSigmas * sigma;
    double squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < offered_; ++i) {
        if (narrow_[i] == 0.0F || used_[i] != 0.0F) continue;
        const double off = residual_[i];
        if (!(std::abs(off) < gate)) {
            squares += gate * gate;
        } else {
            squares += off * off;
        }
        count += 1.0;
    }
    return squares <= kRoughRim * sigma * sigma * count;
}

std::optional<ShapeFit> ShapeFitter::fit_round(const Shape& guess, bool fixed_size) {
    if (!(guess.size > 0.0)) return std::nullopt;
    ShapeFit fit;
    fit.shape = guess;
    const double sigma = mean_sigma();
    const double px_m = guess.point.norm() / camera_.fx;
    Way way;
    way.active = unknowns_of(guess.kind, fixed_size);
    way.gate_steps = kFirstGateSigmas * sigma;
    way.rim_m = kRimAtFirst * px_m;
    Equations sums;
    if (!settle(fit.shape, way, sums)) return std::nullopt;
    const bool long_one = guess.kind != ShapeKind::sphere;
    if (long_one) {
        // All pixels that meet it tell where it ends; then its middle, where shift and turn part.
        find_ends(fit.shape, sigma, way);
        if (guess.kind == ShapeKind::cylinder && way.low > -1e5) {
            const double middle = 0.5 * (way.low + way.high);
            fit.shape.point += middle * fit.shape.axis;
            way.low -= middle;
            way.high -= middle;
        }
    }
    // The rim is known as well as the shape's place sideways, in the middle of what is seen.
    const Matrix6d rough = sigma * sigma * sums.information.inverse();
    const double h =
        guess.kind == ShapeKind::cone && way.low > -1e5 ? 0.5 * (way.low + way.high) : 0.0;
    const double sideways2 = rough(0, 0) + 2.0 * h * rough(0, 4) + h * h * rough(4, 4);
    const double wide = way.rim_m;
    way.rim_m = std::max(kMinRim * px_m, kRimSigmas * std::sqrt(std::max(0.0, sideways2)));
    way.choose = true;
    if (way.rim_m < wide && !rim_is_sound(fit.shape, way, wide, sigma)) way.rim_m = wide;
    if (!settle(fit.shape, way, sums)) return std::nullopt;

    const auto unknowns =
        static_cast<double>(std::count(way.active.begin(), way.active.end(), true));
    const double variance = sigma * sigma * inflation(sigma, unknowns);
    Matrix6d local = variance * sums.information.inverse();
    for (int i = 0; i < 6; ++i)
        if (!way.active[static_cast<std::size_t>(i)]) local(i, i) = 0.0;
    fit.size_u = std::sqrt(local(5, 5));
    fit.low = long_one ? way.low : 0.0;
    fit.high = long_one ? way.high : 0.0;
    // The sixth unknown makes place for the turn about the axis.
    local.row(5).setZero();
    local.col(5).setZero();
    if (long_one) local(5, 5) = kAnyAngle;
    if (guess.kind == ShapeKind::cylinder) {
        const double end_m = 0.5 * px_m;
        local(2, 2) = 0.5 * end_m * end_m;  // the middle of two ends
    }
    Matrix6d turn = Matrix6d::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = way.R_cam_shape;
    fit.covariance = turn * local * turn.transpose();
    assess(fit, sigma);
    return fit;
}

/// s = m·d/step with m = n/h is linear, so that only the outliers' weights ask for repetition.
std::optional<ShapeFit> ShapeFitter::fit_plane(const Shape& guess) {
    const double per_step = 1.0 / scale_.inverse_depth_step;
    const double offset = guess.axis.dot(guess.point);
    if (!(std::abs(offset) > 1e-6)) return std::nullopt;
    Eigen::Vector3d m = guess.axis / offset;
    const double sigma = mean_sigma();
    const double last_gate = kLastGateSigmas * sigma;
    double gate = kFirstGateSigmas * sigma;
    Eigen::Matrix3d information;
    PlaneSums sums;
    bool settled = false;
    for (int i = 0; i < kMaxIterations && !settled; ++i) {
        const Eigen::Vector3f at = (m * per_step).cast<float>();
        sums = linearise_plane(
            {x_.size(), x_.data(), y_.data(), s_.data(), weight_.data(), residual_.data()},
            {at.x(), at.y(), at.z()},
            static_cast<float>(gate)
        );
        if (sums.weights < static_cast<double>(kFewestPixels) / 2.0) return std::nullopt;
        information << sums.xx, sums.xy, sums.x, sums.xy, sums.yy, sums.y, sums.x, sums.y,
            sums.weights;
        information *= per_step * per_step;
        const auto solver = information.ldlt();
        if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
        const Eigen::Vector3d gradient = per_step * Eigen::Vector3d(sums.rx, sums.ry, sums.r);
        const Eigen::Vector3d step = solver.solve(gradient);
        if (!step.allFinite()) return std::nullopt;
        m += step;
        settled = gate <= last_gate && std::sqrt(std::abs(step.dot(gradient))) < kSettled * sigma;
        gate = std::max(last_gate, 0.5 * gate);
    }
    const double length = m.norm();
    if (!(length > 1e-6)) return std::nullopt;

    // Pixels on one line determine no plane: its smallest axis in the picture would be noise.
    const Eigen::Vector2d middle(sums.x / sums.weights, sums.y / sums.weights);
    const double var_x = sums.xx / sums.weights - middle.x() * middle.x();
    const double var_y = sums.yy / sums.weights - middle.y() * middle.y();
    const double cov = sums.xy / sums.weights - middle.x() * middle.y();
    const double half_px = 0.5 / camera_.fx;
    if (!(var_x * var_y - cov * cov > half_px * half_px * (var_x + var_y))) return std::nullopt;

    ShapeFit fit;
    fit.shape.kind = ShapeKind::plane;
    const Eigen::Vector3d d(middle.x(), middle.y(), 1.0);
    const double w = m.dot(d);
    if (!(w > 0.0)) return std::nullopt;
    fit.shape.point = d / w;
    Eigen::Vector3d normal = m / length;  // n·p = 1/|m| > 0: away from the camera
    const double variance = sigma * sigma * inflation(sigma, 3.0);
    const Eigen::Matrix3d of_m = variance * information.inverse();
    // The point moves along its ray by -Z² δm·d, which is a shift of the plane along its normal of
    // n·d as much; and δn = (1 - n nᵀ) δm/|m| is a turn n x δn.
    const double z2 = 1.0 / (w * w);
    Eigen::Matrix<double, 6, 3> by_m;
    by_m.topRows<3>() = normal * (-z2 * normal.dot(d)) * d.transpose();
    Eigen::Matrix3d cross;
    cross << 0.0, -normal.z(), normal.y(), normal.z(), 0.0, -normal.x(), -normal.y(), normal.x(),
        0.0;
    by_m.bottomRows<3>() = cross / length;
    fit.covariance = by_m * of_m * by_m.transpose();
    // Along the plane only the outline tells where its middle is, and nothing how it is turned.
    const double outline_m = 0.5 * fit.shape.point.z() / camera_.fx;
    const Eigen::Matrix3d along = normal * normal.transpose();
    fit.covariance.topLeftCorner<3, 3>() +=
        outline_m * outline_m * (Eigen::Matrix3d::Identity() - along);
    fit.covariance.bottomRightCorner<3, 3>() += kAnyAngle * along;
    fit.shape.axis = -normal;
    assess(fit, sigma);
    return fit;
}

/// By how much the variance is more than σ² promises: the residuals' own scatter, and what
/// neighbouring pixels err together. Sums over blocks larger than a sensor's correlation window
/// scatter by as much more than independent errors would let them as the fit does.
double ShapeFitter::inflation(double sigma, double unknowns) {
    std::fill(block_sum_.begin(), block_sum_.end(), 0.0);
    std::fill(block_squares_.begin(), block_squares_.end(), 0.0);
    const auto width = static_cast<std::uint32_t>(camera_.width);
    double squares = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < offered_; ++i) {
        if (weight_[i] <= 0.0F) continue;
        const auto block = pixel_[i] / width / kBlock * static_cast<std::uint32_t>(block_columns_) +
                           pixel_[i] % width / kBlock;
        const double error = weight_[i] * residual_[i];
        block_sum_[block] += error;
        block_squares_[block] += error * error;
        squares += error * residual_[i];
        weights += weight_[i];
    }
    of_blocks_ *= kFading;
    of_pixels_ *= kFading;
    for (std::size_t i = 0; i < block_sum_.size(); ++i) {
        of_blocks_ += block_sum_[i] * block_sum_[i] / (sigma * sigma);
        of_pixels_ += block_squares_[i] / (sigma * sigma);
    }
    const double chi2 = squares / (sigma * sigma) / std::max(1.0, weights - unknowns);
    const double correlated = of_pixels_ > 0.0 ? std::max(1.0, of_blocks_ / of_pixels_) : 1.0;
    return std::max(1.0, chi2) * correlated;
}

void ShapeFitter::assess(ShapeFit& fit, double sigma) const {
    const auto gate = static_cast<float>(kLastGateSigmas * sigma);
    std::size_t inliers = 0, kept = 0;
    double squares = 0.0, loss = 0.0;
    for (std::size_t i = 0; i < offered_; ++i) {
        const float off = std::abs(residual_[i]);  // NaN where the ray does not meet the shape
        if (!(off <= gate)) {
            loss += 1.0;
            continue;
        }
        const double t = 1.0 - off * off / (gate * gate);
        loss += 1.0 - t * t * t;
        ++inliers;
        if (weight_[i] <= 0.0F) continue;
        ++kept;
        squares += off * off;
    }
    const auto all = static_cast<double>(offered_);
    fit.quality.points = static_cast<int>(inliers);
    fit.quality.inlier_share = static_cast<double>(inliers) / all;
    fit.quality.rms_steps = kept > 0 ? std::sqrt(squares / static_cast<double>(kept)) : 0.0;
    fit.cost = loss / all;
}

}  // namespace kinectlab
