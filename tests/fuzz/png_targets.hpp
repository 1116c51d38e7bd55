#pragma once

#include "tests/fuzz/mutation.hpp"

namespace kinectlab::fuzz {

/// A damaged file fails at its checksums, so damage behind them is tried with sound checksums. Both
/// read a depth picture twice, once plainly and once in a file that libspng must read, and throw if
/// the two differ.
[[nodiscard]] Bytes png_rows();  ///< with the number of its filter before each
[[nodiscard]] bool read_png_rows(const Bytes& rows);
[[nodiscard]] Bytes png_data();  ///< rows, compressed
[[nodiscard]] bool read_png_data(const Bytes& data);

}  // namespace kinectlab::fuzz
