#include "pipeline/track/round_settle.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "pipeline/track/fitted_shape.hpp"

namespace kinectlab {
namespace {

constexpr int kChoices = 2;           // of the pixels at the last gate
constexpr double kLongestStep = 0.3;  // of the radius; rad for angles
constexpr double kShortestCone_m = 0.05;
constexpr double kMaxSize_m = 2.0, kMaxAngle = 1.4, kMinAngle = 0.03;
constexpr double kShrinking = 0.7;  // from step to step; else it swings about the solution
constexpr double kStillMoving = 1.0;

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

RoundEquations equations(const NormalSums& found, const RoundUnknowns& active) {
    RoundEquations sums;  // of what is known the equation is "no change"
    std::array<int, 6> unknown{};
    std::size_t count = 0, k = 0;
    for (int i = 0; i < 6; ++i)
        if (active[static_cast<std::size_t>(i)]) unknown[count++] = i;
    for (std::size_t row = 0; row < count; ++row) {
        const int r = unknown[row];
        sums.gradient[r] = found.gradient[row];
        for (std::size_t column = 0; column <= row; ++column, ++k) {
            const int c = unknown[column];
            sums.information(r, c) = sums.information(c, r) = found.products[k];
        }
    }
    sums.pixels = found.weights;
    return sums;
}

/// The step, cut short where it would leave the shape behind. A slim cone's apex may be far from
/// what is seen of it, and has as far to go.
Vector6d bounded(const Vector6d& step, const Shape& shape, const Eigen::Vector3d& middle_cam) {
    const bool cone = shape.kind == ShapeKind::cone;
    const double reach =
        cone ? std::max(kShortestCone_m, height_on(shape, middle_cam)) : shape.size;
    const double shift = step.head<3>().norm() / (kLongestStep * reach);
    const double turn = step.segment<2>(3).norm() / kLongestStep;
    const double growth = std::abs(step[5]) / (kLongestStep * shape.size);
    return step / std::max({1.0, shift, turn, growth});
}

void move(Shape& shape, const Eigen::Matrix3d& R_cam_shape, const Vector6d& step) {
    shape.point += R_cam_shape * step.head<3>();
    if (shape.kind != ShapeKind::sphere)
        shape.axis =
            (shape.axis + R_cam_shape * Eigen::Vector3d(step[4], -step[3], 0.0)).normalized();
    shape.size += step[5];
}

bool has_sound_size(const Shape& shape) {
    const bool cone = shape.kind == ShapeKind::cone;
    return shape.size > (cone ? kMinAngle : 1e-3) && shape.size < (cone ? kMaxAngle : kMaxSize_m);
}

}  // namespace

RoundUnknowns unknowns_of(ShapeKind kind, bool fixed_size) {
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

void choose_shape_pixels(
    ShapePixels& pixels, const DisparityScale& scale, const Shape& shape, const RoundWay& way
) {
    // Rays that meet a slimmer shape meet this one surely.
    Shape slim = shape;
    const bool cone = shape.kind == ShapeKind::cone;
    const double deeper = cone ? way.rim_m / std::sin(shape.size) : 0.0;
    slim.point += deeper * shape.axis;
    if (!cone) slim.size = std::max(0.5 * shape.size, shape.size - way.rim_m);
    const RoundOptics optics =
        round_optics(slim, shape, way.R_cam_shape, 1.0 / scale.inverse_depth_step);
    choose_pixels(pixels.round(), optics, way.low - deeper, way.high - deeper);
}

RoundEquations linearise_shape(
    ShapePixels& pixels, const DisparityScale& scale, const Shape& shape, const RoundWay& way
) {
    const RoundOptics optics =
        round_optics(shape, shape, way.R_cam_shape, 1.0 / scale.inverse_depth_step);
    const NormalSums found = linearise_round(pixels.round(), optics, way.gate_steps, way.active);
    return equations(found, way.active);
}

bool settle(
    ShapePixels& pixels,
    const DisparityScale& scale,
    Shape& shape,
    RoundWay& way,
    RoundEquations& sums
) {
    const double last_gate = kLastGateSigmas * way.sigma;
    const Eigen::Vector3d middle_cam = pixels.middle(scale);
    double length = 0.0;  // of a step, in standard deviations of what it changes
    int at_last_gate = 0;
    way.R_cam_shape = frame_of(shape);
    for (int i = 0; i < way.most_steps; ++i) {
        if (way.choose && !way.chosen) choose_shape_pixels(pixels, scale, shape, way);
        way.chosen = false;
        sums = linearise_shape(pixels, scale, shape, way);
        if (sums.pixels < 0.5 * kFewestFitPixels) return false;
        const auto solver = sums.information.ldlt();
        if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
        const Vector6d step = solver.solve(sums.gradient);
        if (!step.allFinite()) return false;
        const double before = length;
        length = std::sqrt(std::max(0.0, step.dot(sums.gradient))) / way.sigma;
        const bool swings = !way.choose && length > kShrinking * before;
        const Vector6d change = bounded(step, shape, middle_cam);
        move(shape, way.R_cam_shape, swings ? 0.5 * change : change);
        way.R_cam_shape = frame_of(shape);
        if (!has_sound_size(shape)) return false;
        const bool last = way.gate_steps <= last_gate;
        if (last && length < way.settled) return true;
        // Pixels at the rim that come and go would keep the fit from settling.
        if (last && ++at_last_gate >= kChoices) way.choose = false;
        way.gate_steps = std::max(last_gate, 0.5 * way.gate_steps);
    }
    return way.may_stop_short || length < kStillMoving;
}

}  // namespace kinectlab
