#include "pipeline/analysis/free_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kFinestTurn = 0.08;   // rad in one step of the integration
constexpr double kFirstStretch = 0.5;  // s
constexpr std::size_t kFirstSamples = 10;

Quaterniond rotation(const Vector3d& by) {
    const double angle = by.norm();
    return angle > 0.0 ? Quaterniond(Eigen::AngleAxisd(angle, by / angle))
                       : Quaterniond::Identity();
}

/// Attitude of the principal axes, and angular velocity in them.
struct Turning {
    Quaterniond q;
    Vector3d w;
};

/// Euler's equations without torque.
Vector3d acceleration(const Vector3d& moments, const Vector3d& w) {
    return moments.cwiseProduct(w).cross(w).cwiseQuotient(moments);
}

/// Fourth order in the angular velocity; the attitude turns by Magnus' fourth-order exponent.
void advance(const Vector3d& moments, double time, Turning& s) {
    const int steps = std::max(1, static_cast<int>(std::ceil(s.w.norm() * time / kFinestTurn)));
    const double h = time / steps;
    const double gauss = std::sqrt(3.0) / 6.0;
    for (int i = 0; i < steps; ++i) {
        const Vector3d k1 = acceleration(moments, s.w);
        const Vector3d k2 = acceleration(moments, s.w + h / 2 * k1);
        const Vector3d k3 = acceleration(moments, s.w + h / 2 * k2);
        const Vector3d k4 = acceleration(moments, s.w + h * k3);
        const Vector3d end = s.w + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        const Vector3d slope_end = acceleration(moments, end);
        const auto within = [&](double x) -> Vector3d {  // Hermite's cubic
            const double y = x - 1.0;
            return y * y * (1 + 2 * x) * s.w + x * y * y * h * k1 + x * x * (3 - 2 * x) * end +
                   x * x * y * h * slope_end;
        };
        const Vector3d w1 = within(0.5 - gauss);
        const Vector3d w2 = within(0.5 + gauss);
        s.q = s.q * rotation(h / 2 * (w1 + w2) + std::sqrt(3.0) / 12.0 * h * h * w1.cross(w2));
        s.w = end;
    }
    s.q.normalize();
}

std::vector<PathParameter> start(
    std::span<const AttitudeSample> first, const FreeBodySettings& settings
) {
    std::vector<PathParameter> parameters(static_cast<std::size_t>(free_body::kCount));
    Vector3d rate;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> steps;
        for (std::size_t i = 1; i < std::min<std::size_t>(first.size(), 8); ++i)
            steps.push_back(
                turn_between(first[i - 1].q_lab_obj, first[i].q_lab_obj)[axis] /
                (first[i].t - first[i - 1].t)
            );
        rate[axis] = median(std::move(steps));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        parameters[i] = {0.0, 0.01, 0.0, -1.0};
        parameters[3 + i] = {rate[axis], 0.01, 0.0, -1.0};
        parameters[6 + i] = {0.0, 0.01, 0.0, settings.mount_u_rad};
        if (settings.size_m) {
            const double size = (*settings.size_m)[axis];
            parameters[9 + i] = {size, 0.1 * size, size, settings.size_u_m};
        } else {
            // Three moments of any body differ by less than a factor of some; only two are free.
            parameters[9 + i] = {0.0, 0.1, 0.0, i == 0 ? 0.0 : 1.0};
        }
    }
    return parameters;
}

}  // namespace

Vector3d free_body::box_moments(const Vector3d& size_m) {
    const Vector3d squares = size_m.cwiseAbs2();
    const Vector3d moments = Vector3d::Constant(squares.sum()) - squares;
    return moments / moments[0];
}

Vector3d FreeBody::moments(const VectorXd& p) const {
    const Vector3d shape = p.segment<3>(free_body::kShape);
    if (!box) return shape.array().exp();
    if (shape.minCoeff() <= 0.0)
        return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return free_body::box_moments(shape);
}

Vector3d FreeBody::momentum(const VectorXd& p) const {
    const Quaterniond q = rotation(p.segment<3>(free_body::kTurn)) * first *
                          rotation(p.segment<3>(free_body::kMount));
    const Vector3d w = q.conjugate() * Vector3d(p.segment<3>(free_body::kRate));
    return q * Vector3d(moments(p).cwiseProduct(w));
}

double FreeBody::energy(const VectorXd& p) const {
    return momentum(p).dot(p.segment<3>(free_body::kRate));
}

void FreeBody::motion(
    const VectorXd& p,
    double start_s,
    std::span<const double> t,
    std::span<Quaterniond> q,
    std::span<Vector3d> rate
) const {
    const Quaterniond mount = rotation(p.segment<3>(free_body::kMount));
    const Vector3d shares = moments(p);
    const Vector3d lab_rate = p.segment<3>(free_body::kRate);
    const bool possible = shares.allFinite() && lab_rate.allFinite() && lab_rate.norm() < 1e4;
    Turning s{rotation(p.segment<3>(free_body::kTurn)) * first * mount, {}};
    s.w = s.q.conjugate() * lab_rate;
    double now = start_s;
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (possible) advance(shares, t[i] - now, s);
        now = t[i];
        q[i] = s.q * mount.conjugate();
        if (!possible) q[i].coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
        if (!rate.empty()) rate[i] = s.q * s.w;
    }
}

Result<FreeBody> fit_free_body(
    std::span<const AttitudeSample> samples, const FreeBodySettings& settings
) {
    std::vector<double> turns;
    double noise = 0.0;
    for (std::size_t i = 1; i < samples.size(); ++i)
        turns.push_back(turn_between(samples[i - 1].q_lab_obj, samples[i].q_lab_obj).norm());
    for (const auto& s : samples)
        noise += std::sqrt(3.0) / s.whiten.norm() / static_cast<double>(samples.size());
    const double fastest = median(turns);
    const double ambiguous = std::numbers::pi / (settings.alike ? 2.0 : 1.0);
    if (fastest > ambiguous / 3.0)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format(
                "the body turns {:.0f}° from frame to frame", fastest * 180.0 / std::numbers::pi
            ),
            fmt::format(
                "up to {:.0f}° can be followed: let it turn more slowly",
                ambiguous / 3.0 * 180.0 / std::numbers::pi
            )
        );
    FreeBody body;
    body.first = samples.front().q_lab_obj;
    body.box = settings.size_m.has_value();
    auto parameters = start(samples, settings);
    const AttitudeModel model =
        [&](const VectorXd& p, std::span<const double> t, std::span<Quaterniond> q) {
            body.motion(p, samples.front().t, t, q, {});
        };
    for (double stretch = kFirstStretch;; stretch *= 2.0) {
        std::size_t count = 0;
        while (count < samples.size() && samples[count].t - samples.front().t <= stretch)
            ++count;
        count = std::min(std::max(count, kFirstSamples), samples.size());
        auto fit = fit_attitudes(samples.first(count), model, parameters, settings.alike);
        if (!fit) return tl::unexpected(fit.error());
        for (std::size_t i = 0; i < parameters.size(); ++i)
            parameters[i].start = fit->parameters[static_cast<Eigen::Index>(i)];
        if (count == samples.size()) {
            body.fit = std::move(*fit);
            break;
        }
    }
    const double turned = body.fit.parameters.segment<3>(free_body::kRate).norm() *
                          (samples.back().t - samples.front().t);
    if (turned < 5.0 * noise)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format("the body turns by {:.3f} rad in all, no more than its noise", turned),
            "give it a spin, or measure for longer"
        );
    return body;
}

}  // namespace kinectlab
