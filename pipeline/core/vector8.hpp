#pragma once

#include <cstring>

/// Eight floats side by side, for loops that work on eight neighbouring pixels at once. The
/// compiler makes AVX2 or pairs of SSE operations of them, whichever the surrounding
/// KINECTLAB_HOT_LOOP is compiled for; so everything here is inlined there. Include in .cpp files
/// only. In memory that a loop is given they must lie in a struct with alignas(32): outside of AVX2
/// code their own alignment is 16.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // about passing them to functions that are not inlined

namespace kinectlab {

using Float8 = float __attribute__((vector_size(32)));
using Mask8 = int __attribute__((vector_size(32)));  ///< 0 or -1 in each

#define KINECTLAB_INLINE [[gnu::always_inline]] inline

KINECTLAB_INLINE Float8 load8(const float* from) {
    Float8 value;
    std::memcpy(&value, from, sizeof value);
    return value;
}
KINECTLAB_INLINE void store8(float* to, const Float8& value) {
    std::memcpy(to, &value, sizeof value);
}
KINECTLAB_INLINE Float8 all8(float value) {
    return Float8{} + value;
}
/// The value where the mask is set, 0 elsewhere, even where the value is NaN.
KINECTLAB_INLINE Float8 keep8(const Float8& value, const Mask8& mask) {
    return reinterpret_cast<Float8>(reinterpret_cast<Mask8>(value) & mask);
}
KINECTLAB_INLINE Float8 choose8(const Mask8& mask, const Float8& yes, const Float8& no) {
    return mask ? yes : no;
}
KINECTLAB_INLINE Float8 abs8(const Float8& value) {
    return reinterpret_cast<Float8>(reinterpret_cast<Mask8>(value) & (Mask8{} + 0x7FFFFFFF));
}

}  // namespace kinectlab

#pragma GCC diagnostic pop
