#include "pipeline/analysis/noise_memory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace kinectlab {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kTimeStep = 1.5;  // between neighbours on the grid

/// A fit whose noise has been made white.
struct Whitened {
    MatrixXd information;
    VectorXd pull;
    double squares = 0.0;
    double log_determinant = 0.0;
};

/// Kalman's filter for a fading state under white noise: its innovations are white.
void add_whitened(
    const FitSeries& series, const NoiseMemory& memory, int directions, Whitened& sum
) {
    const Index n = sum.pull.size();
    Jacobian3 state = Jacobian3::Zero(3, n + 1);
    Jacobian3 row(3, n + 1);
    double p = memory.share;
    for (std::size_t i = 0; i < series.t.size(); ++i) {
        if (i > 0) {
            const double fade = memory.time_s > 0.0
                                    ? std::exp(-(series.t[i] - series.t[i - 1]) / memory.time_s)
                                    : 0.0;
            state *= fade;
            p = fade * fade * p + (1.0 - fade * fade) * memory.share;
        }
        row.leftCols(n) = series.jacobian[i];
        row.col(n) = series.residual[i];
        row -= state;
        const double s = p + 1.0 - memory.share;
        state += p / s * row;
        p *= (1.0 - memory.share) / s;
        const auto j = row.leftCols(n);
        const auto r = row.col(n);
        sum.information.noalias() += j.transpose() * j / s;
        sum.pull.noalias() += j.transpose() * r / s;
        sum.squares += r.squaredNorm() / s;
        sum.log_determinant += directions * std::log(s);
    }
}

}  // namespace

NoiseMemories::NoiseMemories(double step_s, double longest_s, int directions)
    : directions_(directions) {
    candidates_.push_back({});
    for (double time = step_s; time <= std::max(longest_s, step_s); time *= kTimeStep)
        for (const double share : {0.4, 0.7, 1.0})
            candidates_.push_back({{time, share, 1.0, 0.0}, 0.0, 0.0});
}

void NoiseMemories::add(std::span<const FitSeries> series, const VectorXd& information) {
    const Index n = information.size();
    for (Candidate& candidate : candidates_) {
        Whitened sum{MatrixXd::Zero(n, n), VectorXd::Zero(n), 0.0, 0.0};
        for (const FitSeries& one : series)
            add_whitened(one, candidate.memory, directions_, sum);
        sum.information.diagonal() += information;
        // Parameters of any size: the scale is the same for every candidate and drops out.
        VectorXd scale(n);
        for (Index i = 0; i < n; ++i) {
            double squares = information[i];
            for (const FitSeries& one : series)
                for (const auto& j : one.jacobian)
                    squares += j.col(i).squaredNorm();
            scale[i] = squares > 0.0 ? 1.0 / std::sqrt(squares) : 1.0;
        }
        MatrixXd scaled = scale.asDiagonal() * sum.information * scale.asDiagonal();
        scaled.diagonal().array() += 1e-12;
        const Eigen::LDLT<MatrixXd> solver(scaled);
        const VectorXd pull = scale.asDiagonal() * sum.pull;
        candidate.squares += sum.squares - pull.dot(solver.solve(pull));
        candidate.log_determinants +=
            sum.log_determinant + solver.vectorD().cwiseMax(1e-12).array().log().sum();
    }
    for (const FitSeries& one : series)
        freedom_ += directions_ * static_cast<double>(one.t.size());
    freedom_ -= static_cast<double>(n);
}

std::vector<NoiseMemory> NoiseMemories::weighed() const {
    std::vector<NoiseMemory> memories;
    std::vector<double> likelihoods;
    const double freedom = std::max(freedom_, 1.0);
    for (const Candidate& candidate : candidates_) {
        NoiseMemory memory = candidate.memory;
        memory.variance = std::max(candidate.squares, 1e-12) / freedom;
        likelihoods.push_back(
            -0.5 * (candidate.log_determinants + freedom * std::log(memory.variance))
        );
        memories.push_back(memory);
    }
    const double best = *std::max_element(likelihoods.begin(), likelihoods.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < memories.size(); ++i) {
        // One memory of none stands against three shares of each time.
        memories[i].weight = std::exp(likelihoods[i] - best) * (i == 0 ? 3.0 : 1.0);
        sum += memories[i].weight;
    }
    for (auto& memory : memories)
        memory.weight /= sum;
    return memories;
}

MatrixXd score_covariance(const FitSeries& series, const NoiseMemory& memory) {
    const Index n = series.jacobian.empty() ? 0 : series.jacobian.front().cols();
    MatrixXd own = MatrixXd::Zero(n, n);
    MatrixXd cross = MatrixXd::Zero(n, n);
    Jacobian3 before = Jacobian3::Zero(3, n);
    for (std::size_t i = 0; i < series.t.size(); ++i) {
        const Jacobian3& j = series.jacobian[i];
        own.noalias() += j.transpose() * j;
        if (memory.time_s <= 0.0) continue;
        if (i > 0) {
            before += series.jacobian[i - 1];
            before *= std::exp(-(series.t[i] - series.t[i - 1]) / memory.time_s);
        }
        cross.noalias() += j.transpose() * before;
    }
    return memory.variance * (own + memory.share * (cross + cross.transpose()));
}

double mean_memory_s(std::span<const NoiseMemory> memories) {
    double mean = 0.0;
    for (const auto& memory : memories)
        mean += memory.weight * memory.share * memory.time_s;
    return mean;
}

}  // namespace kinectlab
