#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/fuzz/mutation.hpp"

namespace kinectlab::fuzz {

/// One reader of files from outside: it has to answer any bytes with a value or an error.
struct Target {
    std::string name;
    std::vector<Bytes> seeds;  ///< sound files of its kind
    /// Whether the bytes were taken. Must not throw, crash, hang or take memory without bound.
    bool (*read)(const Bytes& bytes);
};

[[nodiscard]] std::vector<Target> all_targets();

}  // namespace kinectlab::fuzz
