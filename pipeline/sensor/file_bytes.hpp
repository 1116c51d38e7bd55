#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "pipeline/core/error.hpp"

namespace kinectlab {

/// Reads a whole file of at most `max_bytes` into `bytes`, which is reused. Errors name the file.
[[nodiscard]] Result<void> read_file(
    const std::filesystem::path& file, std::size_t max_bytes, std::vector<std::uint8_t>& bytes
);

/// Throws if the disk does not take it.
void write_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace kinectlab
