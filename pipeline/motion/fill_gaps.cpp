#include "pipeline/motion/fill_gaps.hpp"

#include <algorithm>
#include <limits>

namespace kinectlab {
namespace {

/// Cubic with given ends and slopes on 0..1; slopes for the whole interval.
struct Hermite {
    Eigen::Vector3d p0, m0, p1, m1;

    [[nodiscard]] Eigen::Vector3d value(double s) const {
        const double s2 = s * s, s3 = s2 * s;
        return (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * p1 +
               (s3 - s2) * m1;
    }
    [[nodiscard]] Eigen::Vector3d slope(double s) const {
        const double s2 = s * s;
        return (6 * s2 - 6 * s) * (p0 - p1) + (3 * s2 - 4 * s + 1) * m0 + (3 * s2 - 2 * s) * m1;
    }
    [[nodiscard]] Eigen::Vector3d curvature(double s) const {
        return (12 * s - 6) * (p0 - p1) + (6 * s - 4) * m0 + (6 * s - 2) * m1;
    }
};

Hermite through(const MotionSample& a, const MotionSample& b, double seconds) {
    const bool curved = a.v_lab.allFinite() && b.v_lab.allFinite();
    const Eigen::Vector3d chord = b.p_lab - a.p_lab;
    return {
        a.p_lab,
        curved ? Eigen::Vector3d(a.v_lab * seconds) : chord,
        b.p_lab,
        curved ? Eigen::Vector3d(b.v_lab * seconds) : chord};
}

void fill(MotionSample& sample, const MotionSample& a, const MotionSample& b) {
    const double seconds = to_seconds(b.t - a.t);
    const double s = to_seconds(sample.t - a.t) / seconds;
    const Hermite path = through(a, b, seconds);
    sample.status = TrackStatus::interpolated;
    sample.p_lab = path.value(s);
    sample.v_lab = path.slope(s) / seconds;
    sample.a_lab = path.curvature(s) / (seconds * seconds);
    sample.has_orientation = a.has_orientation && b.has_orientation;
    if (sample.has_orientation) sample.q_lab_obj = a.q_lab_obj.slerp(s, b.q_lab_obj);
    sample.w_lab = (1.0 - s) * a.w_lab + s * b.w_lab;
    sample.sigma_v = a.sigma_v.cwiseMax(b.sigma_v);
    sample.sigma_a = a.sigma_a.cwiseMax(b.sigma_a);
    sample.sigma_w = a.sigma_w.cwiseMax(b.sigma_w);
    // What lies between was not seen: add a share of how far the path leaves the straight line.
    sample.covariance = a.covariance.trace() > b.covariance.trace() ? a.covariance : b.covariance;
    const Eigen::Vector3d bend = sample.p_lab - ((1.0 - s) * a.p_lab + s * b.p_lab);
    constexpr double kTrustInBend = 0.1;
    sample.covariance.topLeftCorner<3, 3>() +=
        kTrustInBend * kTrustInBend * bend * bend.transpose();
    sample.quality = {};
    sample.size = {};
}

}  // namespace

void set_lost(MotionSample& sample) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    sample.status = TrackStatus::lost;
    sample.has_orientation = false;
    sample.p_lab.setConstant(nan);
    sample.v_lab.setConstant(nan);
    sample.a_lab.setConstant(nan);
    sample.w_lab.setConstant(nan);
    sample.sigma_v.setConstant(nan);
    sample.sigma_a.setConstant(nan);
    sample.sigma_w.setConstant(nan);
    sample.covariance.setConstant(nan);
}

void fill_gaps(std::span<MotionSample> samples, double max_step_s) {
    const auto tracked = [](const MotionSample& s) {
        return s.status == TrackStatus::tracked;
    };
    auto a = std::find_if(samples.begin(), samples.end(), tracked);
    while (a != samples.end()) {
        const auto b = std::find_if(a + 1, samples.end(), tracked);
        if (b == samples.end()) return;
        if (to_seconds(b->t - a->t) <= max_step_s)
            std::for_each(a + 1, b, [&](MotionSample& between) { fill(between, *a, *b); });
        a = b;
    }
}

}  // namespace kinectlab
