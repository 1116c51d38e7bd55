#include "pipeline/analysis/attitude_samples.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace kinectlab {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDefaultSigma = 0.01;  // rad

Quaterniond turned(const Vector3d& by, const Quaterniond& q) {
    const double angle = by.norm();
    return angle > 0.0 ? Quaterniond(Eigen::AngleAxisd(angle, by / angle)) * q : q;
}

}  // namespace

Vector3d turn_between(const Quaterniond& from, const Quaterniond& to) {
    Quaterniond turn = to * from.conjugate();
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
    const double sine = turn.vec().norm();
    if (sine < 1e-12) return 2.0 * turn.vec();
    return 2.0 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

Quaterniond nearest_alike(const Quaterniond& q, const Quaterniond& expected) {
    const Quaterniond half_turns[] = {
        Quaterniond::Identity(),
        Quaterniond(0.0, 1.0, 0.0, 0.0),
        Quaterniond(0.0, 0.0, 1.0, 0.0),
        Quaterniond(0.0, 0.0, 0.0, 1.0)};
    Quaterniond best = q;
    double closest = -1.0;
    for (const Quaterniond& half : half_turns) {
        const Quaterniond like = q * half;
        const double close = std::abs(like.dot(expected));
        if (close <= closest) continue;
        closest = close;
        best = like;
    }
    return best;
}

Result<std::vector<AttitudeSample>> collect_attitudes(
    const Trajectory& trajectory, bool alike, std::size_t fewest
) {
    const auto& all = trajectory.samples;
    std::vector<AttitudeSample> samples;
    Vector3d rate = Vector3d::Zero();
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i > 0 && all[i].t <= all[i - 1].t)
            return fail(
                ErrorCode::bad_data,
                "t",
                "sample " + std::to_string(i) + " is not later than the one before it",
                "give samples in strictly increasing time"
            );
        if (all[i].status != TrackStatus::tracked || !all[i].has_orientation) continue;
        Quaterniond q = all[i].q_lab_obj;
        const Matrix3d covariance = all[i].covariance.bottomRightCorner<3, 3>();
        if (!q.coeffs().allFinite() || std::abs(q.norm() - 1.0) > 0.01 || !covariance.allFinite())
            return fail(
                ErrorCode::bad_data,
                "q_lab_obj",
                "sample " + std::to_string(i) + " is marked tracked but its orientation is none",
                "mark it lost, or give a quaternion of length one and its covariance"
            );
        q.normalize();
        AttitudeSample sample{
            i, to_seconds(all[i].t - all.front().t), q, Matrix3d::Identity() / kDefaultSigma};
        const Eigen::LLT<Matrix3d> cholesky(covariance);
        if (cholesky.info() == Eigen::Success && covariance.diagonal().minCoeff() > 0.0)
            sample.whiten = cholesky.matrixL().solve(Matrix3d::Identity());
        if (!samples.empty()) {
            const AttitudeSample& last = samples.back();
            const double dt = sample.t - last.t;
            const Quaterniond expected = turned(rate * dt, last.q_lab_obj);
            if (alike) sample.q_lab_obj = nearest_alike(q, expected);
            // A share of each step: one stray attitude does not lead the next ones astray.
            const Vector3d step = turn_between(last.q_lab_obj, sample.q_lab_obj) / dt;
            rate = samples.size() < 3 ? step : Vector3d(0.6 * rate + 0.4 * step);
        }
        samples.push_back(sample);
    }
    if (samples.size() < fewest)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "the object's orientation was seen in " + std::to_string(samples.size()) + " of " +
                std::to_string(all.size()) + " frames",
            "at least " + std::to_string(fewest) +
                " are needed: track it by a method that gives six degrees of freedom"
        );
    return samples;
}

}  // namespace kinectlab
