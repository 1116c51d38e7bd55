#include "server/plots/axis.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace kinectlab::plots {

std::vector<double> Axis::marks() const {
    std::vector<double> all;
    const auto first = static_cast<long long>(std::ceil(low / step - 1e-9));
    const auto last = static_cast<long long>(std::floor(high / step + 1e-9));
    for (long long i = first; i <= last && i - first < 100; ++i)
        all.push_back(static_cast<double>(i) * step);
    return all;
}

std::string Axis::label(double mark) const {
    const double largest = std::max(std::abs(low), std::abs(high));
    const int digits = static_cast<int>(std::ceil(-std::log10(step) - 1e-9));
    if (largest >= 1e5 || digits > 4) return fmt::format("{:.3g}", mark);
    return fmt::format("{:.{}f}", mark == 0.0 ? 0.0 : mark, std::max(digits, 0));
}

Axis axis_for(double low, double high, int wanted) {
    if (!(high > low)) {
        const double room = low == 0.0 ? 1.0 : std::abs(low) * 0.05;
        low -= room;
        high += room;
    }
    const double margin = 0.04 * (high - low);
    Axis axis{low - margin, high + margin, 1.0};
    const double raw = (axis.high - axis.low) / wanted;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    const double share = raw / power;
    axis.step = power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
    return axis;
}

}  // namespace kinectlab::plots
