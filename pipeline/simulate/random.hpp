#pragma once

#include <cstdint>
#include <vector>

namespace kinectlab::simulate {

/// Steele, Lea & Flood 2014 (SplitMix64): a good hash of a counter.
constexpr std::uint64_t mix(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

/// The random numbers of one frame. Every row draws its own place in a table of ready-made numbers,
/// so that a frame costs a few hashes a row, and depends on seed and index alone.
class FrameRandom {
public:
    FrameRandom(std::uint64_t seed, std::uint64_t frame) : key_(mix(seed ^ mix(frame))) {}

    [[nodiscard]] std::uint64_t draw(std::uint32_t purpose, std::uint32_t row) const {
        return mix(key_ ^ (std::uint64_t{purpose} << 32U | row));
    }
    /// From 0 up to 1.
    [[nodiscard]] double uniform(std::uint32_t purpose, std::uint32_t row) const {
        return static_cast<double>(draw(purpose, row) >> 11U) * 0x1.0p-53;
    }

private:
    std::uint64_t key_;
};

constexpr std::size_t kTablePlaces = 1U << 17U;  ///< where a row may begin
constexpr std::size_t kLongestRow = 2048;        ///< what may be read from there

/// kTablePlaces + kLongestRow numbers from N(0, 1), mean and variance exact; made once.
[[nodiscard]] const std::vector<float>& gaussian_table();

/// As many bytes, uniform.
[[nodiscard]] const std::vector<std::uint8_t>& byte_table();

/// Where in a table a row begins.
[[nodiscard]] inline std::size_t place(std::uint64_t draw) {
    return draw & (kTablePlaces - 1);
}

}  // namespace kinectlab::simulate
