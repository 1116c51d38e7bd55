#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab::testing {

enum class Lasting { no, yes };

/// Positions p(t), t in s, recorded at 30 Hz with noise of half a millimetre, two along y, which
/// may last for five frames.
inline Trajectory record(
    double seconds,
    const std::function<Eigen::Vector3d(double)>& p,
    unsigned seed = 1,
    Lasting lasting = Lasting::no,
    double noise = 1.0
) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Eigen::Vector3d sigma = noise * Eigen::Vector3d(5e-4, 2e-3, 5e-4);
    const double share = lasting == Lasting::yes ? std::exp(-0.2) : 0.0;
    Eigen::Vector3d off = Eigen::Vector3d::Zero();
    Trajectory path{"body", {}};
    for (int i = 0; i < static_cast<int>(seconds * 30.0); ++i) {
        for (int k = 0; k < 3; ++k) {
            const double rest = i == 0 ? 1.0 : std::sqrt(1.0 - share * share);
            off[k] = share * off[k] + rest * sigma[k] * normal(random);
        }
        MotionSample m;
        m.t = 1'700'000'000'000'000'000 + from_seconds(i / 30.0);
        m.status = TrackStatus::tracked;
        m.p_lab = p(i / 30.0) + off;
        m.covariance.topLeftCorner<3, 3>() =
            (sigma + Eigen::Vector3d::Constant(1e-6)).cwiseAbs2().asDiagonal();
        path.samples.push_back(m);
    }
    return path;
}

inline Result<AnalysisOutcome> analysed(
    const std::string& method,
    const Trajectory& path,
    const AnalysisSettings& settings = {},
    const AnalysisConditions& conditions = {}
) {
    return analyse(method, std::span(&path, 1), settings, conditions);
}

inline const Measurement* find(const AnalysisOutcome& out, const std::string& name) {
    for (const auto& m : out.measurements)
        if (m.name == name) return &m;
    return nullptr;
}

inline const Measurement& named(const AnalysisOutcome& out, const std::string& name) {
    if (const Measurement* m = find(out, name)) return *m;
    throw std::out_of_range("no measurement " + name);
}

inline double line(const Measurement& m, const std::string& source) {
    for (const auto& b : m.budget)
        if (b.source == source) return b.u;
    return -1.0;
}

}  // namespace kinectlab::testing
