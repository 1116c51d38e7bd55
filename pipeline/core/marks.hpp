#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace kinectlab {

/// Calls `act` with the index of each byte that is not 0, in order; made for few among many.
template <class Act>
void for_each_marked(std::span<const std::uint8_t> marks, Act act) {
    for (std::size_t k = 0; k < marks.size(); ++k) {
        std::uint64_t eight = 1;
        if (k + 8 <= marks.size()) std::memcpy(&eight, marks.data() + k, 8);
        if (eight == 0) {
            k += 7;
        } else if (marks[k] != 0) {
            act(k);
        }
    }
}

}  // namespace kinectlab
