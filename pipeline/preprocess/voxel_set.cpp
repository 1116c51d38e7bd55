#include "pipeline/preprocess/voxel_set.hpp"

#include <bit>

namespace kinectlab {

VoxelSet::VoxelSet() : slots_(1024) {}

void VoxelSet::insert(std::int32_t x, std::int32_t y, std::int32_t z) {
    const std::uint64_t block = block_of(x, y, z);
    std::size_t at = find(block);
    if (slots_[at].block == 0) {
        if (2 * ++used_ > slots_.size()) {
            grow();
            at = find(block);
        }
        slots_[at].block = block;
    }
    slots_[at].word |= std::uint64_t{1} << bit_of(x, y, z);
}

std::size_t VoxelSet::size() const {
    std::size_t occupied = 0;
    for (const auto& slot : slots_)
        occupied += static_cast<std::size_t>(std::popcount(slot.word));
    return occupied;
}

void VoxelSet::grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const auto& slot : old)
        if (slot.block != 0) slots_[find(slot.block)] = slot;
}

}  // namespace kinectlab
