#include "pipeline/sensor/png_filters.hpp"

#include <cstdlib>
#include <cstring>

namespace kinectlab {
namespace {

constexpr std::size_t kLanes = 8;
using Bytes16 = std::uint8_t __attribute__((vector_size(2 * kLanes)));
using Counts8 = std::uint16_t __attribute__((vector_size(2 * kLanes)));

/// The high byte comes first in the file.
constexpr std::size_t kHigh = 0, kLow = 1;

/// Adds to each byte what `predict` makes of the bytes left, above and above left of it: of the
/// same half of the neighbours' counts. Begins at column x, with what is known of those before it.
template <class Predict>
void add_prediction(
    const std::uint8_t* filtered,
    const std::uint16_t* above,
    std::span<std::uint16_t> out,
    std::size_t x,
    Predict predict
) {
    const int left = x > 0 ? out[x - 1] : 0;
    int high = left >> 8, low = left & 0xff, corner = x > 0 ? above[x - 1] : 0;
    for (; x < out.size(); ++x) {
        const int up = above[x];
        high = (filtered[2 * x + kHigh] + predict(high, up >> 8, corner >> 8)) & 0xff;
        low = (filtered[2 * x + kLow] + predict(low, up & 0xff, corner & 0xff)) & 0xff;
        out[x] = static_cast<std::uint16_t>(high << 8 | low);
        corner = up;
    }
}

/// The filter that nearly all depth pictures use, eight columns at a time: each becomes the sum of
/// all up to it. The columns that were done.
std::size_t add_left(const std::uint8_t* filtered, std::span<std::uint16_t> out) {
    const Counts8 zero{};
    Bytes16 left{};  // the last column before these eight, in each of them
    std::size_t x = 0;
    for (; x + kLanes <= out.size(); x += kLanes) {
        Bytes16 sum;
        std::memcpy(&sum, filtered + 2 * x, sizeof sum);
        auto pixels = reinterpret_cast<Counts8>(sum);
        sum += reinterpret_cast<Bytes16>(
            __builtin_shufflevector(zero, pixels, 0, 8, 9, 10, 11, 12, 13, 14)
        );
        pixels = reinterpret_cast<Counts8>(sum);
        sum += reinterpret_cast<Bytes16>(
            __builtin_shufflevector(zero, pixels, 0, 1, 8, 9, 10, 11, 12, 13)
        );
        pixels = reinterpret_cast<Counts8>(sum);
        sum += reinterpret_cast<Bytes16>(
            __builtin_shufflevector(zero, pixels, 0, 1, 2, 3, 8, 9, 10, 11)
        );
        sum += left;
        pixels = reinterpret_cast<Counts8>(sum);
        left = reinterpret_cast<Bytes16>(
            __builtin_shufflevector(pixels, pixels, 7, 7, 7, 7, 7, 7, 7, 7)
        );
        const Counts8 counts =
            __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? (pixels << 8U) | (pixels >> 8U) : pixels;
        std::memcpy(out.data() + x, &counts, sizeof counts);
    }
    return x;
}

/// Whichever neighbour is nearest to their plane; the first of equals.
int paeth(int left, int up, int corner) {
    const int plane = left + up - corner;
    const int to_left = std::abs(plane - left);
    const int to_up = std::abs(plane - up);
    const int to_corner = std::abs(plane - corner);
    if (to_left <= to_up && to_left <= to_corner) return left;
    return to_up <= to_corner ? up : corner;
}

}  // namespace

bool undo_png_filter(
    int filter,
    const std::uint8_t* filtered,
    const std::uint16_t* above,
    std::span<std::uint16_t> out
) {
    const auto add = [&](std::size_t first, auto predict) {
        add_prediction(filtered, above, out, first, predict);
        return true;
    };
    switch (filter) {
        case 0:
            return add(0, [](int, int, int) { return 0; });
        case 1:
            return add(add_left(filtered, out), [](int left, int, int) { return left; });
        case 2:
            return add(0, [](int, int up, int) { return up; });
        case 3:
            return add(0, [](int left, int up, int) { return (left + up) / 2; });
        case 4:
            return add(0, paeth);
        default:
            return false;
    }
}

}  // namespace kinectlab
