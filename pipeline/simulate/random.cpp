#include "pipeline/simulate/random.hpp"

#include <cmath>
#include <numbers>

namespace kinectlab::simulate {
namespace {

double uniform_at(std::uint64_t counter) {
    return (static_cast<double>(mix(counter) >> 11U) + 0.5) * 0x1.0p-53;
}

/// Box and Muller; then the table's own mean and variance are set right.
std::vector<float> make_gaussians() {
    std::vector<double> values(kTablePlaces);
    for (std::size_t i = 0; i < values.size(); i += 2) {
        const double radius = std::sqrt(-2.0 * std::log(uniform_at(i)));
        const double angle = 2.0 * std::numbers::pi * uniform_at(i + 1);
        values[i] = radius * std::cos(angle);
        values[i + 1] = radius * std::sin(angle);
    }
    double sum = 0.0;
    double squares = 0.0;
    for (const double value : values) {
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kTablePlaces;
    const double deviation = std::sqrt(squares / kTablePlaces - mean * mean);
    std::vector<float> table(kTablePlaces + kLongestRow);
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = static_cast<float>((values[i % kTablePlaces] - mean) / deviation);
    return table;
}

std::vector<std::uint8_t> make_bytes() {
    std::vector<std::uint8_t> table(kTablePlaces + kLongestRow);
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = static_cast<std::uint8_t>(mix(~(i % kTablePlaces)) >> 56U);
    return table;
}

}  // namespace

const std::vector<float>& gaussian_table() {
    static const std::vector<float> table = make_gaussians();
    return table;
}

const std::vector<std::uint8_t>& byte_table() {
    static const std::vector<std::uint8_t> table = make_bytes();
    return table;
}

}  // namespace kinectlab::simulate
