#include "pipeline/track/round_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "pipeline/track/round_settle.hpp"
#include "pipeline/track/shape_ends.hpp"
#include "pipeline/track/shape_quality.hpp"

namespace kinectlab {
namespace {

constexpr double kRimAtFirst = 0.7;  // px inside the outline: what is farther out is left out
constexpr double kMinRim = 0.02;     // px
constexpr double kRoughRim = 2.0;    // times σ²: the sensor's rims are worse than its faces
constexpr double kRimSigmas = 3.0;   // of the shape across the rays, once it is known
constexpr double kRoughlySettled = 0.3, kSettled = 0.1;  // σ: the next is a tenth of it
constexpr int kStepsToCompare = 8;
constexpr double kEndGateSigmas = 3.0;
constexpr double kEndMarginPx = 1.5;

/// A pixel's width at the shape, m.
double px_at(const Shape& shape, const Pinhole& camera) {
    return shape.point.norm() / camera.fx;
}

RoundWay first_way(
    const ShapePixels& pixels,
    const Pinhole& camera,
    const DisparityScale& scale,
    const Shape& guess
) {
    RoundWay way;
    way.sigma = pixels.mean_sigma(scale);
    way.gate_steps = kFirstGateSigmas * way.sigma;
    way.rim_m = kRimAtFirst * px_at(guess, camera);
    way.settled = kRoughlySettled;
    return way;
}

/// All pixels that meet it tell where it ends; a cylinder's point becomes its middle, where shift
/// and turn part.
void bound_ends(const ShapePixels& pixels, double focal_px, Shape& shape, RoundWay& way) {
    const double sine = shape.point.normalized().cross(shape.axis).norm();
    const double margin = kEndMarginPx * shape.point.z() / focal_px / std::max(0.3, sine);
    if (const auto ends = seen_ends(pixels, kEndGateSigmas * way.sigma, margin)) {
        way.low = ends->low;
        way.high = ends->high;
    }
    if (shape.kind != ShapeKind::cylinder || !way.has_ends()) return;
    const double middle = 0.5 * (way.low + way.high);
    shape.point += middle * shape.axis;
    way.low -= middle;
    way.high -= middle;
}

/// How far the shape may be off sideways, in the middle of what is seen of it.
double sideways_u(ShapeKind kind, const RoundWay& way, const RoundEquations& sums) {
    const Matrix6d rough = way.sigma * way.sigma * sums.information.inverse();
    const double h = kind == ShapeKind::cone && way.has_ends() ? 0.5 * (way.low + way.high) : 0.0;
    const double variance = rough(0, 0) + 2.0 * h * rough(0, 4) + h * h * rough(4, 4);
    return std::sqrt(std::max(0.0, variance));
}

/// Leaves out what is this near to the outline, or as much as before if the pixels there err more
/// than the others. They tell most of a size, but a real sensor's look aside a little, which shows
/// where the surface is steep. The pixels are linearised for this shape.
void narrow_rim(
    ShapePixels& pixels,
    const DisparityScale& scale,
    const Shape& shape,
    double rim_m,
    RoundWay& way
) {
    way.choose = true;
    if (!(rim_m < way.rim_m)) {
        way.rim_m = rim_m;
        return;
    }
    choose_shape_pixels(pixels, scale, shape, way);
    const double wide_m = std::exchange(way.rim_m, rim_m);
    pixels.chosen_before.swap(pixels.used);
    pixels.used.resize(pixels.x.size());
    choose_shape_pixels(pixels, scale, shape, way);
    const RimSums rim = sum_rim(pixels, kLastGateSigmas * way.sigma);
    way.chosen = rim.squares <= kRoughRim * way.sigma * way.sigma * rim.pixels;
    if (!way.chosen) way.rim_m = wide_m;
}

/// From the shape's own frame into the camera's. The sixth unknown makes place for the turn about
/// the axis.
Matrix6d covariance_of(const Shape& shape, const RoundWay& way, Matrix6d local, double end_m) {
    local.row(5).setZero();
    local.col(5).setZero();
    if (shape.kind != ShapeKind::sphere) local(5, 5) = kAnyAngle;
    if (shape.kind == ShapeKind::cylinder)
        local(2, 2) = 0.5 * end_m * end_m;  // the middle of two ends
    Matrix6d turn = Matrix6d::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = way.R_cam_shape;
    return turn * local * turn.transpose();
}

}  // namespace

std::optional<ShapeFit> fit_round(
    ShapePixels& pixels,
    const Pinhole& camera,
    const DisparityScale& scale,
    const Shape& guess,
    FitStart start,
    bool fixed_size,
    CorrelatedNoise& noise
) {
    if (!(guess.size > 0.0)) return std::nullopt;
    ShapeFit fit;
    fit.shape = guess;
    const double px_m = px_at(guess, camera);
    RoundWay way = first_way(pixels, camera, scale, guess);
    way.active = unknowns_of(guess.kind, fixed_size);
    if (start == FitStart::refined) {  // one step tells how sure it is now
        way.gate_steps = kLastGateSigmas * way.sigma;
        way.most_steps = 1;
        way.may_stop_short = true;
    }
    RoundEquations sums;
    if (!settle(pixels, scale, fit.shape, way, sums)) return std::nullopt;
    way.settled = kSettled;
    way.most_steps = kMostFitSteps;
    way.may_stop_short = false;
    sums = linearise_shape(pixels, scale, fit.shape, way);
    const bool long_one = guess.kind != ShapeKind::sphere;
    if (long_one) bound_ends(pixels, camera.fx, fit.shape, way);
    // The rim is known as well as the shape's place.
    const double rim_m = std::max(kMinRim * px_m, kRimSigmas * sideways_u(guess.kind, way, sums));
    narrow_rim(pixels, scale, fit.shape, rim_m, way);
    if (!settle(pixels, scale, fit.shape, way, sums)) return std::nullopt;

    const auto unknowns =
        static_cast<double>(std::count(way.active.begin(), way.active.end(), true));
    const double variance = way.sigma * way.sigma * noise.inflation(pixels, way.sigma, unknowns);
    Matrix6d local = variance * sums.information.inverse();
    for (int i = 0; i < 6; ++i)
        if (!way.active[static_cast<std::size_t>(i)]) local(i, i) = 0.0;
    fit.size_u = std::sqrt(local(5, 5));
    fit.low = long_one ? way.low : 0.0;
    fit.high = long_one ? way.high : 0.0;
    fit.covariance = covariance_of(fit.shape, way, local, 0.5 * px_m);
    const ShapeQuality found = judge_fit(pixels, kLastGateSigmas * way.sigma);
    fit.quality = found.quality;
    fit.cost = found.cost;
    return fit;
}

double misfit_round(
    ShapePixels& pixels, const Pinhole& camera, const DisparityScale& scale, const Shape& guess
) {
    if (!(guess.size > 0.0)) return 1.0;
    RoundWay way = first_way(pixels, camera, scale, guess);
    way.active = unknowns_of(guess.kind, false);
    way.most_steps = kStepsToCompare;
    way.may_stop_short = true;
    Shape shape = guess;
    RoundEquations sums;
    if (!settle(pixels, scale, shape, way, sums)) return 1.0;
    return judge_fit(pixels, kLastGateSigmas * way.sigma).cost;
}

}  // namespace kinectlab
