#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/preprocess/voxel_set.hpp"

namespace kinectlab {

/// How many points each voxel has got; for cells as VoxelSet takes them.
class VoxelCounts {
public:
    /// Room for this many points, each of which may lie in a voxel of its own.
    explicit VoxelCounts(std::size_t points)
        : slots_(std::bit_ceil(2 * points + 2)),
          shift_(64 - static_cast<unsigned>(std::countr_zero(slots_.size()))) {}

    /// Counts a point; returns the place of its voxel.
    std::uint32_t add(std::int32_t x, std::int32_t y, std::int32_t z) {
        const auto part = [](std::int32_t cell) {
            return static_cast<std::uint64_t>(cell + VoxelSet::kReach);
        };
        const std::uint64_t voxel = (part(x) << 42U | part(y) << 21U | part(z)) + 1;
        std::size_t at = voxel * 0x9E3779B97F4A7C15U >> shift_;
        while (slots_[at].voxel != voxel && slots_[at].voxel != 0)
            at = (at + 1) & (slots_.size() - 1);
        slots_[at].voxel = voxel;
        ++slots_[at].points;
        return static_cast<std::uint32_t>(at);
    }
    [[nodiscard]] int points_at(std::uint32_t place) const { return slots_[place].points; }

private:
    struct Slot {
        std::uint64_t voxel = 0;  ///< 0 = free
        int points = 0;
    };
    std::vector<Slot> slots_;
    unsigned shift_;
};

}  // namespace kinectlab
