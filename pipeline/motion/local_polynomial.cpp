#include "pipeline/motion/local_polynomial.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Dense>

namespace kinectlab {
namespace {

constexpr int kDegree = 3;
using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kDegree + 1, kDegree + 1>;
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kDegree + 1, 1>;

std::span<const TimedVector> within(
    std::span<const TimedVector> samples, TimeNs t, double half_window_s
) {
    const TimeNs half = from_seconds(half_window_s);
    const auto before = [](const TimedVector& sample, TimeNs time) {
        return sample.t < time;
    };
    const auto first = std::lower_bound(samples.begin(), samples.end(), t - half + 1, before);
    const auto last = std::lower_bound(first, samples.end(), t + half, before);
    return {first, last};
}

}  // namespace

double half_window_s(double bandwidth_hz) {
    // Where the response of the Epanechnikov-weighted local cubic's slope to a sine is 1/sqrt(2).
    constexpr double kBandwidthTimesHalfWindow = 0.7047;
    return kBandwidthTimesHalfWindow / bandwidth_hz;
}

std::optional<Derivatives> differentiate(
    std::span<const TimedVector> samples, TimeNs t, double half_window_s
) {
    const auto window = within(samples, t, half_window_s);
    if (window.size() < 3) return std::nullopt;
    const int degree = std::min<int>(kDegree, static_cast<int>(window.size()) - 2);

    Derivatives result;
    for (int axis = 0; axis < 3; ++axis) {
        // Time in half windows keeps the powers of the same size.
        Normal normal = Normal::Zero(degree + 1, degree + 1), spread = normal;
        Coefficients right = Coefficients::Zero(degree + 1);
        for (const auto& sample : window) {
            const double tau = to_seconds(sample.t - t) / half_window_s;
            const double near = 1.0 - tau * tau;
            const double weight = near / sample.variance[axis];
            Coefficients powers(degree + 1);
            powers[0] = 1.0;
            for (int k = 1; k <= degree; ++k)
                powers[k] = powers[k - 1] * tau;
            normal += weight * powers * powers.transpose();
            spread += weight * near * powers * powers.transpose();
            right += weight * sample.value[axis] * powers;
        }
        const Normal inverse = normal.inverse();
        const Coefficients fitted = inverse * right;
        const Normal covariance = inverse * spread * inverse;
        result.first[axis] = fitted[1] / half_window_s;
        result.first_variance[axis] = covariance(1, 1) / (half_window_s * half_window_s);
        const double per_square = 2.0 / (half_window_s * half_window_s);
        const double nan = std::numeric_limits<double>::quiet_NaN();
        result.second[axis] = degree >= 2 ? per_square * fitted[2] : nan;
        result.second_variance[axis] =
            degree >= 2 ? per_square * per_square * covariance(2, 2) : nan;
    }
    return result;
}

}  // namespace kinectlab
