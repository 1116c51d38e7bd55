#include "pipeline/analysis/swing_model.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace kinectlab {
namespace {

using State = SwingPath::State;
using Rows = Eigen::Array<double, 11, 1>;

constexpr double kPhaseStep = 0.12;  // rad: frequency right to 0.12⁶/5040 = 6e-10

/// s. A wide swing is faster at its bottom than a sine of its period.
double longest_step(const SwingParameters& p) {
    const double fastest_sq = p.v.squaredNorm() + 2.0 * p.omega0_sq * (1.0 + p.n.z());
    return kPhaseStep / std::sqrt(p.omega0_sq + fastest_sq);
}

// Rows of the state below the motion itself.
enum Row {
    kRowDirection = 1,
    kRowVelocity = 3,
    kRowOmega = 5,
    kRowTilt = 6,
    kRowDamping = 8,
    kRowQuadratic = 9,
    kRowTurning = 10
};

Eigen::Matrix<double, 3, 2> down_by_tilt(const SwingParameters& p) {
    const Eigen::Vector3d raw(p.tilt.x(), p.tilt.y(), -1.0);
    const Eigen::Vector3d down = raw.normalized();
    const Eigen::Matrix3d across =
        (Eigen::Matrix3d::Identity() - down * down.transpose()) / raw.norm();
    return across.leftCols<2>();
}

Eigen::Vector3d across(const Eigen::Vector3d& a, const Eigen::Vector3d& n) {
    return a - n * n.dot(a);
}

/// The equation of motion in the first row, its linearisation about it in the others.
class Equation {
public:
    explicit Equation(const SwingParameters& p)
        : gravity_(p.omega0_sq * p.down()),
          down_(p.down()),
          tilts_(p.omega0_sq * down_by_tilt(p)),
          damping_(p.damping),
          quadratic_(p.quadratic),
          turning_(p.turning) {}

    void operator()(const State& y, State& dy) const {
        const Eigen::Vector3d n = y.row(0).head<3>();
        const Eigen::Vector3d v = y.row(0).tail<3>();
        const Eigen::Vector3d turned(-v.y(), v.x(), 0.0);  // z × v
        const double pull = v.squaredNorm() + gravity_.dot(n);
        const double lift = n.dot(turned);

        const Rows nx = y.col(0), ny = y.col(1), nz = y.col(2);
        const Rows vx = y.col(3), vy = y.col(4), vz = y.col(5);
        const Rows d_pull = 2.0 * (v.x() * vx + v.y() * vy + v.z() * vz) + gravity_.x() * nx +
                            gravity_.y() * ny + gravity_.z() * nz;
        const Rows d_lift = v.x() * ny - v.y() * nx + n.y() * vx - n.x() * vy;
        const Rows along = 2.0 * turning_ * d_lift - d_pull;
        const double stay = 2.0 * turning_ * lift - pull;
        const double speed = v.norm();
        const double drag = 2.0 * damping_ + quadratic_ * speed;
        const double by_speed = speed > 0.0 ? quadratic_ / speed : 0.0;
        const Rows d_drag = by_speed * (v.x() * vx + v.y() * vy + v.z() * vz);
        dy.leftCols<3>() = y.rightCols<3>();
        dy.col(3) = stay * nx + n.x() * along - drag * vx - v.x() * d_drag + 2.0 * turning_ * vy;
        dy.col(4) = stay * ny + n.y() * along - drag * vy - v.y() * d_drag - 2.0 * turning_ * vx;
        dy.col(5) = stay * nz + n.z() * along - drag * vz - v.z() * d_drag;

        const Eigen::Vector3d by_turning = -2.0 * (turned - n * lift);
        dy.row(0).tail<3>() = gravity_ - n * pull - drag * v + turning_ * by_turning;
        dy.row(kRowOmega).tail<3>() += across(down_, n);
        dy.row(kRowTilt).tail<3>() += across(tilts_.col(0), n);
        dy.row(kRowTilt + 1).tail<3>() += across(tilts_.col(1), n);
        dy.row(kRowDamping).tail<3>() -= 2.0 * v;
        dy.row(kRowQuadratic).tail<3>() -= speed * v;
        dy.row(kRowTurning).tail<3>() += by_turning;
    }

private:
    Eigen::Vector3d gravity_;
    Eigen::Vector3d down_;
    Eigen::Matrix<double, 3, 2> tilts_;
    double damping_;
    double quadratic_;
    double turning_;
};

void dormand_prince_step(const Equation& f, double h, State& y) {
    State k1, k2, k3, k4, k5, k6;
    f(y, k1);
    f(y + h * (1.0 / 5 * k1), k2);
    f(y + h * (3.0 / 40 * k1 + 9.0 / 40 * k2), k3);
    f(y + h * (44.0 / 45 * k1 - 56.0 / 15 * k2 + 32.0 / 9 * k3), k4);
    f(y + h * (19372.0 / 6561 * k1 - 25360.0 / 2187 * k2 + 64448.0 / 6561 * k3 - 212.0 / 729 * k4),
      k5);
    f(y + h * (9017.0 / 3168 * k1 - 355.0 / 33 * k2 + 46732.0 / 5247 * k3 + 49.0 / 176 * k4 -
               5103.0 / 18656 * k5),
      k6);
    y += h * (35.0 / 384 * k1 + 500.0 / 1113 * k3 + 125.0 / 192 * k4 - 2187.0 / 6784 * k5 +
              11.0 / 84 * k6);
}

}  // namespace

Eigen::Matrix<double, 3, 2> tangent_axes(const Eigen::Vector3d& n) {
    Eigen::Matrix<double, 3, 2> axes;
    axes.col(0) =
        across(std::abs(n.x()) < 0.8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY(), n)
            .normalized();
    axes.col(1) = n.cross(axes.col(0));
    return axes;
}

SwingParameters moved(const SwingParameters& parameters, const SwingVector& step) {
    const auto axes = tangent_axes(parameters.n);
    SwingParameters p = parameters;
    p.pivot += step.segment<3>(kPivot);
    p.radius += step[kRadius];
    p.n = (p.n + axes * step.segment<2>(kDirection)).normalized();
    p.v = across(p.v + axes * step.segment<2>(kVelocity), p.n);
    p.omega0_sq += step[kOmega0Sq];
    p.tilt += step.segment<2>(kTilt);
    p.damping += step[kDamping];
    p.quadratic += step[kQuadratic];
    p.turning += step[kTurning];
    return p;
}

SwingPath::SwingPath(const SwingParameters& start)
    : start_(start), longest_step_(longest_step(start)), state_(State::Zero()) {
    const auto axes = tangent_axes(start.n);
    state_.row(0) << start.n.transpose(), start.v.transpose();
    for (int i = 0; i < 2; ++i) {
        state_.row(kRowDirection + i).head<3>() = axes.col(i);
        state_.row(kRowDirection + i).tail<3>() = -start.n * start.v.dot(axes.col(i));
        state_.row(kRowVelocity + i).tail<3>() = axes.col(i);
    }
}

void SwingPath::go_to(double t) {
    if (t == t_) return;
    const Equation f(start_);
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(t - t_) / longest_step_)));
    const double h = (t - t_) / steps;
    for (int i = 0; i < steps; ++i)
        dormand_prince_step(f, h, state_);
    t_ = t;
}

Eigen::Vector3d SwingPath::position() const {
    return start_.pivot + start_.radius * state_.row(0).head<3>().transpose();
}

SwingJacobian SwingPath::jacobian() const {
    SwingJacobian j;
    j.middleCols<3>(kPivot).setIdentity();
    j.col(kRadius) = state_.row(0).head<3>();
    j.rightCols<10>() = start_.radius * state_.bottomLeftCorner<10, 3>().transpose();
    return j;
}

SwingParameters SwingPath::now() const {
    SwingParameters p = start_;
    p.n = state_.row(0).head<3>().transpose().normalized();
    p.v = across(state_.row(0).tail<3>(), p.n);
    return p;
}

double period_factor(double theta) {
    double a = 1.0;
    double b = std::cos(theta / 2);
    while (std::abs(a - b) > 1e-15) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    return 1.0 / a;
}

}  // namespace kinectlab
