#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace kinectlab {

using Jacobian3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// What a linearised fit left over of one thing, in time order, in units in which the noise is
/// alike in every direction and at every time, with the change of the fit by its parameters.
struct FitSeries {
    std::vector<double> t;  ///< s, increasing
    std::vector<Eigen::Vector3d> residual;
    std::vector<Jacobian3> jacobian;
};

/// Noise of which a share (by variance) stays alike over a time, as exp(-Δt/time), and the rest is
/// new in every sample.
struct NoiseMemory {
    double time_s = 0.0;
    double share = 0.0;
    double variance = 1.0;  ///< of each direction, in the residuals' unit
    double weight = 0.0;    ///< how likely this memory is, of all that were tried
};

/// How long noise lasts, judged by the residuals of one fit or more: the restricted likelihood
/// (Patterson & Thompson, Biometrika 58 (1971)) of each memory on a grid, which allows for what the
/// fitted parameters have taken out of the residuals. The noise filter takes uneven times and gaps.
class NoiseMemories {
public:
    /// Times from one step to `longest_s`. `directions` counts those that have noise at all: 2 for
    /// positions in a plane.
    NoiseMemories(double step_s, double longest_s, int directions = 3);

    /// One fit with parameters of its own; `information` is what was known of them before.
    void add(std::span<const FitSeries> series, const Eigen::VectorXd& information);

    /// All memories with their weights, which add up to one.
    [[nodiscard]] std::vector<NoiseMemory> weighed() const;

private:
    struct Candidate {
        NoiseMemory memory;
        double squares = 0.0;
        double log_determinants = 0.0;
    };
    std::vector<Candidate> candidates_;
    int directions_;
    double freedom_ = 0.0;
};

/// Covariance of the sum of jacobianᵀ · noise over a series with that memory.
[[nodiscard]] Eigen::MatrixXd score_covariance(const FitSeries& series, const NoiseMemory& memory);

/// The time over which the noise is alike, weighted over the memories by its share, s.
[[nodiscard]] double mean_memory_s(std::span<const NoiseMemory> memories);

}  // namespace kinectlab
