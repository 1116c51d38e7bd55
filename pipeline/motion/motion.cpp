#include "pipeline/motion/motion.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "pipeline/motion/fill_gaps.hpp"
#include "pipeline/motion/local_polynomial.hpp"

namespace kinectlab {
namespace {

/// Rotates both blocks of a covariance of position and rotation vector.
Matrix6d rotated(const Matrix6d& covariance, const Eigen::Matrix3d& R) {
    Matrix6d both = Matrix6d::Zero();
    both.topLeftCorner<3, 3>() = R;
    both.bottomRightCorner<3, 3>() = R;
    return both * covariance * both.transpose();
}

MotionSample in_lab(const TrackSample& sample, const Eigen::Isometry3d& T_lab_cam) {
    MotionSample motion;
    motion.t = sample.t;
    if (sample.status != TrackStatus::tracked || !sample.p_cam.allFinite()) {
        set_lost(motion);
        return motion;
    }
    motion.status = TrackStatus::tracked;
    motion.has_orientation = sample.has_orientation;
    motion.p_lab = T_lab_cam * sample.p_cam;
    if (sample.has_orientation)
        motion.q_lab_obj = Eigen::Quaterniond(T_lab_cam.linear()) * sample.q_cam_obj;
    motion.covariance = rotated(sample.covariance, T_lab_cam.linear());
    motion.quality = sample.quality;
    motion.size = sample.size;
    return motion;
}

/// The rotation vector that turns q0 into q1 in the lab frame, the short way round.
Eigen::Vector3d rotation_between(const Eigen::Quaterniond& q0, const Eigen::Quaterniond& q1) {
    Eigen::Quaterniond turn = q1 * q0.conjugate();
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
    const Eigen::AngleAxisd angle_axis(turn);
    return angle_axis.angle() * angle_axis.axis();
}

/// Stretches of measured samples with no gap longer than allowed: derivatives never reach across.
template <class Use>
void for_each_stretch(std::vector<MotionSample>& samples, double max_gap_s, Use use) {
    std::vector<MotionSample*> stretch;
    for (auto& sample : samples) {
        if (sample.status != TrackStatus::tracked) continue;
        if (!stretch.empty() && to_seconds(sample.t - stretch.back()->t) > max_gap_s) {
            use(std::as_const(stretch));
            stretch.clear();
        }
        stretch.push_back(&sample);
    }
    if (!stretch.empty()) use(std::as_const(stretch));
}

/// A variance that is missing (0) counts like any other.
Eigen::Vector3d weightable(const Eigen::Vector3d& variance) {
    return (variance.array() > 0.0 && variance.array().isFinite()).select(variance, 1.0);
}

bool is_known(const Eigen::Vector3d& variance) {
    return variance.allFinite() && variance.minCoeff() > 0.0;
}

/// Standard uncertainties; NaN where a variance that they rest on is missing.
Eigen::Vector3d sigma(const Eigen::Vector3d& variance, bool known) {
    if (!known) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return variance.cwiseSqrt();
}

void add_linear(const std::vector<MotionSample*>& stretch, double half_window_s) {
    std::vector<TimedVector> positions;
    positions.reserve(stretch.size());
    bool known = true;
    for (const auto* sample : stretch) {
        const Eigen::Vector3d variance = sample->covariance.diagonal().head<3>();
        known = known && is_known(variance);
        positions.push_back({sample->t, sample->p_lab, weightable(variance)});
    }
    for (auto* sample : stretch) {
        const auto found = differentiate(positions, sample->t, half_window_s);
        const double nan = std::numeric_limits<double>::quiet_NaN();
        sample->v_lab = found ? found->first : Eigen::Vector3d::Constant(nan);
        sample->a_lab = found ? found->second : Eigen::Vector3d::Constant(nan);
        sample->sigma_v = sigma(found ? found->first_variance : sample->v_lab, known);
        sample->sigma_a = sigma(found ? found->second_variance : sample->a_lab, known);
    }
}

/// Near one pose the rotation vectors from it to its neighbours grow as the angular velocity says.
void add_angular(const std::vector<MotionSample*>& stretch, double half_window_s) {
    std::vector<TimedVector> turns;
    for (std::size_t i = 0; i < stretch.size(); ++i) {
        MotionSample& here = *stretch[i];
        if (!here.has_orientation) continue;
        const auto near = [&](const MotionSample& other) {
            return std::abs(to_seconds(other.t - here.t)) < half_window_s;
        };
        std::size_t first = i;
        while (first > 0 && near(*stretch[first - 1]))
            --first;
        turns.clear();
        bool known = true;
        for (std::size_t k = first; k < stretch.size() && near(*stretch[k]); ++k)
            if (stretch[k]->has_orientation) {
                const Eigen::Vector3d variance = stretch[k]->covariance.diagonal().tail<3>();
                known = known && is_known(variance);
                turns.push_back(
                    {stretch[k]->t,
                     rotation_between(here.q_lab_obj, stretch[k]->q_lab_obj),
                     weightable(variance)}
                );
            }
        const auto found = differentiate(turns, here.t, half_window_s);
        here.w_lab = found ? found->first
                           : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
        here.sigma_w = sigma(found ? found->first_variance : here.w_lab, known);
    }
}

}  // namespace

Trajectory to_trajectory(
    std::string object,
    std::span<const TrackSample> samples,
    const Eigen::Isometry3d& T_lab_cam,
    const MotionSettings& settings
) {
    Trajectory trajectory;
    trajectory.object = std::move(object);
    trajectory.samples.reserve(samples.size());
    for (const auto& sample : samples)
        if (trajectory.samples.empty() || sample.t > trajectory.samples.back().t)
            trajectory.samples.push_back(in_lab(sample, T_lab_cam));

    const double max_step_s = settings.max_gap_s + settings.frame_period_s;
    const double window_s = half_window_s(settings.bandwidth_hz);
    for_each_stretch(trajectory.samples, max_step_s, [&](const auto& stretch) {
        add_linear(stretch, window_s);
        add_angular(stretch, window_s);
    });
    fill_gaps(trajectory.samples, max_step_s);
    return trajectory;
}

}  // namespace kinectlab
