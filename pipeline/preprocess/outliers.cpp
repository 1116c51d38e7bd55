#include "pipeline/preprocess/outliers.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "pipeline/core/number_text.hpp"
#include "pipeline/preprocess/mean_distances.hpp"

namespace kinectlab {
namespace {

/// PCL's formula: points without a reading count in the sums, with 0, but not in their number.
double threshold_of(const std::vector<float>& distances, std::size_t valid, double factor) {
    double sum = 0.0;
    double squares = 0.0;
    for (const float distance : distances) {
        sum += distance;
        squares += distance * distance;
    }
    const auto n = static_cast<double>(valid);
    const double variance = (squares - sum * sum / n) / (n - 1.0);
    return sum / n + factor * std::sqrt(variance);
}

Result<void> check(const OutlierSettings& settings) {
    if (settings.neighbours < 1 || settings.neighbours > OutlierSettings::kMostNeighbours)
        return fail(
            ErrorCode::invalid_argument,
            "neighbours",
            "is " + std::to_string(settings.neighbours),
            "give a whole number from 1 to " + std::to_string(OutlierSettings::kMostNeighbours)
        );
    if (!std::isfinite(settings.sigma_factor) || settings.sigma_factor < 0.0)
        return fail(
            ErrorCode::invalid_argument,
            "sigma_factor",
            "is " + number_text(settings.sigma_factor),
            "give a number of standard deviations that is not negative, such as 1"
        );
    return {};
}

}  // namespace

Result<Outliers> find_outliers(const Cloud& cloud, const OutlierSettings& settings) {
    if (auto right = check_shape(cloud); !right) return tl::unexpected(right.error());
    if (auto right = check(settings); !right) return tl::unexpected(right.error());

    std::size_t valid = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        valid += cloud.valid(i) ? 1 : 0;
    Outliers result;
    result.mask.assign(cloud.size(), 0);
    result.mean_distance.assign(cloud.size(), 0.0F);
    if (valid == 0) return result;
    if (valid <= static_cast<std::size_t>(settings.neighbours))
        return fail(
            ErrorCode::invalid_argument,
            "neighbours",
            "is " + std::to_string(settings.neighbours) + ", but the cloud has only " +
                std::to_string(valid) + " points with a reading",
            "give fewer neighbours than there are points"
        );

    result.mean_distance = mean_distances(cloud, settings.neighbours);
    result.threshold_m = threshold_of(result.mean_distance, valid, settings.sigma_factor);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const bool out = result.mean_distance[i] > result.threshold_m;
        result.mask[i] = out ? 1 : 0;
        result.count += out ? 1 : 0;
    }
    return result;
}

void clear_points(Cloud& cloud, const std::vector<std::uint8_t>& mask) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (mask[i] != 0) cloud.x[i] = cloud.y[i] = cloud.z[i] = kNone;
}

}  // namespace kinectlab
