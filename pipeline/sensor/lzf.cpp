#include "pipeline/sensor/lzf.hpp"

#include <algorithm>

namespace kinectlab {

bool decompress_lzf(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
    std::size_t from = 0;
    std::size_t to = 0;
    while (from < in.size()) {
        const std::size_t control = in[from++];
        if (control < 32) {  // a run of control + 1 bytes as they are
            const std::size_t run = control + 1;
            if (run > in.size() - from || run > out.size() - to) return false;
            std::copy_n(
                in.begin() + static_cast<std::ptrdiff_t>(from),
                run,
                out.begin() + static_cast<std::ptrdiff_t>(to)
            );
            from += run;
            to += run;
            continue;
        }
        // A copy of what was written before: 3 bits of length, 13 of distance, longer lengths in a
        // byte more.
        std::size_t length = control >> 5U;
        if (length == 7) {
            if (from == in.size()) return false;
            length += in[from++];
        }
        length += 2;
        if (from == in.size()) return false;
        const std::size_t distance = ((control & 31U) << 8U) + in[from++] + 1;
        if (distance > to || length > out.size() - to) return false;
        // Byte by byte, because the copy may overlap its own source.
        for (std::size_t i = 0; i < length; ++i, ++to)
            out[to] = out[to - distance];
    }
    return to == out.size();
}

}  // namespace kinectlab
