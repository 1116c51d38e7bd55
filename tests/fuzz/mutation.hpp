#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace kinectlab::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// A damaged copy: one to eight changes out of flipped bits, other bytes, numbers put in the place
/// of others, pieces cut out, doubled or taken from `other`, and a cut end. At most 64 KiB.
[[nodiscard]] Bytes mutated(const Bytes& input, const Bytes& other, std::mt19937_64& random);

}  // namespace kinectlab::fuzz
