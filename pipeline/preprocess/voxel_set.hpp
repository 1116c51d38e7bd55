#pragma once

#include <cstdint>
#include <vector>

namespace kinectlab {

/// Which voxels of a grid without bounds are occupied: one bit each, 4 x 4 x 4 to a word, the words
/// in a hash table. Cells are whole numbers from -kReach up to and without kReach.
class VoxelSet {
public:
    static constexpr std::int32_t kReach = 1 << 20;

    VoxelSet();
    void insert(std::int32_t x, std::int32_t y, std::int32_t z);
    [[nodiscard]] bool contains(std::int32_t x, std::int32_t y, std::int32_t z) const {
        return (word(block_of(x, y, z)) >> bit_of(x, y, z) & 1U) != 0;
    }
    /// How many voxels are occupied.
    [[nodiscard]] std::size_t size() const;

    /// A number for the 64 voxels about this one, never 0.
    [[nodiscard]] static std::uint64_t block_of(std::int32_t x, std::int32_t y, std::int32_t z) {
        const auto part = [](std::int32_t cell) {
            return static_cast<std::uint64_t>(cell + kReach) >> 2U;
        };
        return (part(x) << 40U | part(y) << 20U | part(z)) + 1;
    }
    [[nodiscard]] static unsigned bit_of(std::int32_t x, std::int32_t y, std::int32_t z) {
        return (static_cast<unsigned>(x) & 3U) << 4U | (static_cast<unsigned>(y) & 3U) << 2U |
               (static_cast<unsigned>(z) & 3U);
    }
    /// The occupied among a block's voxels.
    [[nodiscard]] std::uint64_t word(std::uint64_t block) const { return slots_[find(block)].word; }

private:
    struct Slot {
        std::uint64_t block = 0;  ///< 0 = free
        std::uint64_t word = 0;
    };
    [[nodiscard]] std::size_t find(std::uint64_t block) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = (block * 0x9E3779B97F4A7C15U >> 20U) & mask;
        while (slots_[at].block != 0 && slots_[at].block != block)
            at = (at + 1) & mask;
        return at;
    }
    void grow();

    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

}  // namespace kinectlab
