#include "pipeline/features/voxel_surface.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr int kBits = 21;  // of a key for each coordinate
constexpr std::int32_t kHalf = 1 << (kBits - 1);
constexpr std::uint64_t kMask = (1ULL << kBits) - 1;

/// Points of one voxel summed; several of them may bear the same key until they are merged.
struct Sum {
    std::uint64_t key = 0;  // layer, row, column
    Eigen::Vector3f p_cam = Eigen::Vector3f::Zero();
    float value = 0.0F;
    float weight = 0.0F;
};

std::uint64_t key_of(std::int32_t x, std::int32_t y, std::int32_t z) {
    const auto part = [](std::int32_t c) {
        return static_cast<std::uint64_t>(c + kHalf);
    };
    return (part(z) << (2 * kBits)) | (part(y) << kBits) | part(x);
}

/// By the lowest digits first, 11 bits at a time; digits that do not vary are passed over.
void sort_by_key(std::vector<Sum>& sums) {
    constexpr int kDigit = 11;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(sums.size()), other(sums.size());
    std::uint64_t all_or = 0, all_and = ~0ULL;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        order[i] = {sums[i].key, static_cast<std::uint32_t>(i)};
        all_or |= sums[i].key;
        all_and &= sums[i].key;
    }
    const std::uint64_t varying = all_or ^ all_and;
    for (int shift = 0; shift < 3 * kBits; shift += kDigit) {
        constexpr std::uint64_t kDigitMask = (1U << kDigit) - 1;
        if (((varying >> shift) & kDigitMask) == 0) continue;
        std::array<std::uint32_t, kDigitMask + 2> starts{};
        for (const auto& [key, index] : order)
            ++starts[((key >> shift) & kDigitMask) + 1];
        for (std::size_t digit = 1; digit < starts.size(); ++digit)
            starts[digit] += starts[digit - 1];
        for (const auto& one : order)
            other[starts[(one.first >> shift) & kDigitMask]++] = one;
        order.swap(other);
    }
    std::vector<Sum> sorted;
    sorted.reserve(sums.size());
    for (const auto& one : order)
        sorted.push_back(sums[one.second]);
    sums.swap(sorted);
}

VoxelSurface surface_of(std::vector<Sum> sums, float voxel_m) {
    sort_by_key(sums);
    VoxelSurface surface;
    surface.voxel_m = voxel_m;
    for (std::size_t i = 0; i < sums.size();) {
        Sum sum = sums[i];
        for (++i; i < sums.size() && sums[i].key == sum.key; ++i) {
            sum.p_cam += sums[i].p_cam;
            sum.value += sums[i].value;
            sum.weight += sums[i].weight;
        }
        const auto part = [&](int shift) {
            return static_cast<std::int32_t>((sum.key >> shift) & kMask) - kHalf;
        };
        const std::int32_t y = part(kBits), z = part(2 * kBits);
        if (surface.rows.empty() || surface.rows.back().y != y || surface.rows.back().z != z)
            surface.rows.push_back({y, z, static_cast<std::uint32_t>(surface.x.size())});
        surface.x.push_back(part(0));
        surface.value.push_back(sum.value / sum.weight);
        surface.p_cam.emplace_back(sum.p_cam / sum.weight);
    }
    if (!surface.rows.empty())
        surface.rows.push_back({0, 0, static_cast<std::uint32_t>(surface.x.size())});
    return surface;
}

}  // namespace

VoxelSurface voxelise(std::span<const ValuedPoint> points, float voxel_m) {
    std::vector<Sum> sums;
    sums.reserve(points.size() / 2 + 1);
    const auto most = static_cast<float>(kHalf - 2);
    for (const auto& point : points) {
        const Eigen::Vector3f at = point.p_cam / voxel_m;
        if (!(at.cwiseAbs().maxCoeff() < most) || !at.allFinite() || !std::isfinite(point.value))
            continue;
        const auto whole = [](float c) {
            return static_cast<std::int32_t>(std::floor(c));
        };
        const std::uint64_t key = key_of(whole(at.x()), whole(at.y()), whole(at.z()));
        // Neighbours in a picture mostly share their voxel: that much is not left to the sorting.
        if (sums.empty() || sums.back().key != key) sums.push_back({key});
        sums.back().p_cam += point.p_cam;
        sums.back().value += point.value;
        sums.back().weight += 1.0F;
    }
    return surface_of(std::move(sums), voxel_m);
}

VoxelSurface halved(const VoxelSurface& fine) {
    std::vector<Sum> sums;
    sums.reserve(fine.size());
    for (std::size_t row = 0; row < fine.row_count(); ++row)
        for (std::uint32_t i = fine.rows[row].first; i < fine.rows[row + 1].first; ++i) {
            const std::uint64_t key =
                key_of(fine.x[i] >> 1, fine.rows[row].y >> 1, fine.rows[row].z >> 1);
            if (sums.empty() || sums.back().key != key) sums.push_back({key});
            sums.back().p_cam += fine.p_cam[i];
            sums.back().value += fine.value[i];
            sums.back().weight += 1.0F;
        }
    return surface_of(std::move(sums), 2.0F * fine.voxel_m);
}

VoxelNeighbours neighbours_of(const VoxelSurface& surface) {
    VoxelNeighbours found;
    found.indices.resize(surface.size() * VoxelNeighbours::kMost);
    found.counts.assign(surface.size(), 0);
    const auto add = [&](std::uint32_t i, std::uint32_t j) {
        found.indices[i * VoxelNeighbours::kMost + found.counts[i]++] = j;
    };
    for_each_row_pair(surface, 2, [&](std::size_t row, std::size_t other, int dy, int dz) {
        if (std::abs(dy) > 1 || std::abs(dz) > 1) return;
        const std::uint32_t end = surface.rows[other + 1].first;
        std::uint32_t from = surface.rows[other].first;
        for (std::uint32_t i = surface.rows[row].first; i < surface.rows[row + 1].first; ++i) {
            while (from < end && surface.x[from] < surface.x[i] - 1)
                ++from;
            for (std::uint32_t j = from; j < end && surface.x[j] <= surface.x[i] + 1; ++j)
                if (j != i) add(i, j);
        }
    });
    return found;
}

}  // namespace kinectlab
