#include "pipeline/analysis/swing_length.hpp"

#include <algorithm>
#include <vector>

namespace kinectlab {
namespace {

constexpr double kRest = 1.0 / 8.0;  // of the path's width; a swing moves a quarter in that time
constexpr double kOutliers = 0.02;   // on either side

/// From outlier to outlier.
Eigen::Vector2d width_of(std::span<const PositionSample> samples) {
    Eigen::Vector2d width = Eigen::Vector2d::Zero();
    for (int axis = 0; axis < 2; ++axis) {
        std::vector<double> places;
        for (const auto& sample : samples)
            places.push_back(sample.p_lab[axis]);
        std::sort(places.begin(), places.end());
        const auto last = static_cast<double>(places.size() - 1);
        const auto low = static_cast<std::size_t>(kOutliers * last);
        const auto high = static_cast<std::size_t>((1.0 - kOutliers) * last);
        width[axis] = places[high] - places[low];
    }
    return width;
}

}  // namespace

double longest_motion_s(std::span<const PositionSample> samples, double period) {
    if (samples.empty()) return 0.0;
    const Eigen::Vector2d width = width_of(samples);
    const int axis = width.x() > width.y() ? 0 : 1;
    double longest = 0.0;
    double start = samples.front().t;
    std::vector<double> places;
    for (std::size_t i = 0, end = 0; i < samples.size(); ++i) {
        while (end < samples.size() && samples[end].t <= samples[i].t + period / 3.0)
            ++end;
        places.clear();
        for (std::size_t k = i; k < end; ++k)
            places.push_back(samples[k].p_lab[axis]);
        std::sort(places.begin(), places.end());
        const std::size_t wild = places.size() / 10;
        const bool known = places.size() >= 4;
        const double spread = places[places.size() - 1 - wild] - places[wild];
        const bool rests = known && samples[end - 1].t - samples[i].t > period / 4.0 &&
                           spread < kRest * width[axis];
        if (!rests) continue;
        longest = std::max(longest, samples[i].t - start);
        start = samples[end - 1].t;
    }
    return std::max(longest, samples.back().t - start);
}

}  // namespace kinectlab
