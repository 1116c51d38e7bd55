#include <algorithm>
#include <cmath>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/features/sift3d.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kLanes = SurfaceOctave::kLanes;
constexpr float kReachSigmas = 2.5F;          // of the widest blur
constexpr std::size_t kFewestNeighbours = 5;  // of the 8 that a flat surface has at least

/// kLanes floats that are computed at once; loops over them would be unrolled before they are seen
/// to be vectors.
using Lanes = float __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

/// σ of a layer in voxels of its octave: the first is one voxel.
float sigma_of(int layer, int scales_per_octave) {
    return std::exp2(static_cast<float>(layer) / static_cast<float>(scales_per_octave));
}

/// Weights of all blurs for each distance along an axis, in voxels.
std::vector<float> weights(int reach, int scales_per_octave) {
    std::vector<float> table(static_cast<std::size_t>(reach + 1) * kLanes, 0.0F);
    for (int d = 0; d <= reach; ++d)
        for (int layer = 0; layer < scales_per_octave + 3; ++layer) {
            const float off = static_cast<float>(d) / sigma_of(layer, scales_per_octave);
            table[static_cast<std::size_t>(d) * kLanes + static_cast<std::size_t>(layer)] =
                std::exp(-0.5F * off * off);
        }
    return table;
}

/// A row blurred along itself: wherever one of its voxels is within reach, occupied or not. The
/// Gaussian is a product, so what other rows take of it is this times a factor for their distance.
struct BlurredRows {
    static constexpr std::size_t kWide = 2 * kLanes;  // weighted values, then weights
    std::vector<std::int32_t> x;
    std::vector<float> sums;           // kWide for each x
    std::vector<std::uint32_t> first;  // of each row, and one past the end
};

/// Adds the voxels [from, end) within reach of x, weighted.
KINECTLAB_HOT_LOOP void add_along(
    const VoxelSurface& surface,
    std::uint32_t from,
    std::uint32_t end,
    std::int32_t x,
    std::int32_t reach,
    const float* __restrict weight,
    float* __restrict out
) {
    Lanes sum = {}, norm = {};
    for (std::uint32_t j = from; j < end && surface.x[j] <= x + reach; ++j) {
        const auto off = static_cast<std::size_t>(std::abs(surface.x[j] - x));
        const Lanes w = *reinterpret_cast<const Lanes*>(weight + off * kLanes);
        sum += w * surface.value[j];
        norm += w;
    }
    reinterpret_cast<Lanes*>(out)[0] = sum;
    reinterpret_cast<Lanes*>(out)[1] = norm;
}

BlurredRows blur_along_rows(
    const VoxelSurface& surface, std::int32_t reach, const std::vector<float>& weight
) {
    BlurredRows rows;
    for (std::size_t row = 0; row < surface.row_count(); ++row) {
        rows.first.push_back(static_cast<std::uint32_t>(rows.x.size()));
        const std::uint32_t end = surface.rows[row + 1].first;
        std::uint32_t from = surface.rows[row].first;
        std::int32_t next = surface.x[from] - reach;
        for (std::uint32_t i = from; i < end; ++i) {
            next = std::max(next, surface.x[i] - reach);
            for (; next <= surface.x[i] + reach; ++next) {
                while (surface.x[from] < next - reach)
                    ++from;
                rows.x.push_back(next);
                rows.sums.resize(rows.sums.size() + BlurredRows::kWide);
                add_along(
                    surface,
                    from,
                    end,
                    next,
                    reach,
                    weight.data(),
                    &rows.sums[rows.sums.size() - BlurredRows::kWide]
                );
            }
        }
    }
    rows.first.push_back(static_cast<std::uint32_t>(rows.x.size()));
    return rows;
}

struct RowPair {
    const std::int32_t* x;
    std::uint32_t own_first, own_end;
    const std::int32_t* other_x;
    const float* other_sums;
    std::uint32_t other_first, other_end;
};

/// Adds what one blurred row contributes to another row's voxels.
KINECTLAB_HOT_LOOP void add_row(
    const RowPair& pair, const float* __restrict factor, float* __restrict sums
) {
    constexpr std::size_t kWide = BlurredRows::kWide;
    const Lanes by = *reinterpret_cast<const Lanes*>(factor);
    std::uint32_t at = pair.other_first;
    for (std::uint32_t i = pair.own_first; i < pair.own_end; ++i) {
        const std::int32_t x = pair.x[i];
        if (pair.other_x[at] < x) {
            // Without a gap between the two, the place is as far on as x is.
            const auto ahead = static_cast<std::uint32_t>(x - pair.other_x[at]);
            const std::uint32_t guess = std::min(at + ahead, pair.other_end);
            if (guess < pair.other_end && pair.other_x[guess] == x) {
                at = guess;
            } else {
                at = static_cast<std::uint32_t>(
                    std::lower_bound(pair.other_x + at, pair.other_x + guess, x) - pair.other_x
                );
                if (at == pair.other_end) return;
            }
        }
        if (pair.other_x[at] != x) continue;
        const auto* add = reinterpret_cast<const Lanes*>(pair.other_sums + at * kWide);
        auto* to = reinterpret_cast<Lanes*>(sums + i * kWide);
        to[0] += by * add[0];
        to[1] += by * add[1];
    }
}

void blur(SurfaceOctave& octave, int scales_per_octave) {
    constexpr std::size_t kWide = BlurredRows::kWide;
    const float widest = sigma_of(scales_per_octave + 2, scales_per_octave);
    const int reach = static_cast<int>(std::ceil(kReachSigmas * widest));
    const std::vector<float> table = weights(reach, scales_per_octave);
    const VoxelSurface& surface = octave.surface;
    const BlurredRows along = blur_along_rows(surface, reach, table);
    std::vector<float> sums(surface.size() * kWide, 0.0F);
    for_each_row_pair(surface, reach, [&](std::size_t row, std::size_t other, int dy, int dz) {
        float factor[kLanes];
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            factor[lane] = table[static_cast<std::size_t>(std::abs(dy)) * kLanes + lane] *
                           table[static_cast<std::size_t>(std::abs(dz)) * kLanes + lane];
        const RowPair pair{
            surface.x.data(),
            surface.rows[row].first,
            surface.rows[row + 1].first,
            along.x.data(),
            along.sums.data(),
            along.first[other],
            along.first[other + 1]};
        add_row(pair, factor, sums.data());
    });
    octave.blurred.resize(surface.size() * kLanes);
    for (std::size_t i = 0; i < surface.size(); ++i)
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const float norm = sums[i * kWide + kLanes + lane];
            octave.blurred[i * kLanes + lane] = norm > 0.0F ? sums[i * kWide + lane] / norm : 0.0F;
        }
}

}  // namespace

std::vector<SurfaceOctave> surface_scale_space(
    std::span<const ValuedPoint> points, const Sift3dSettings& settings
) {
    std::vector<SurfaceOctave> octaves;
    VoxelSurface surface = voxelise(points, settings.smallest_scale_m);
    for (int i = 0; i < settings.octaves && surface.size() > 0; ++i) {
        if (i > 0) surface = halved(surface);
        SurfaceOctave octave;
        octave.surface = surface;
        octave.neighbours = neighbours_of(surface);
        blur(octave, settings.scales_per_octave);
        octaves.push_back(std::move(octave));
    }
    return octaves;
}

namespace {

/// Differences of neighbouring blurs at one voxel.
struct Differences {
    const float* at;
    [[nodiscard]] float operator[](std::size_t layer) const { return at[layer + 1] - at[layer]; }
};

/// Where the response is strongest: the mean of the places around, weighted by how much of the
/// peak's response they have beyond the weakest among them.
Eigen::Vector3f refined_place(const SurfaceOctave& octave, std::uint32_t voxel, std::size_t layer) {
    const auto around = octave.neighbours.of(voxel);
    const auto response = [&](std::uint32_t i) {
        return Differences{&octave.blurred[i * kLanes]}[layer];
    };
    const float peak = response(voxel);
    float weakest = peak;
    for (const auto i : around)
        weakest = peak > 0.0F ? std::min(weakest, response(i)) : std::max(weakest, response(i));
    Eigen::Vector3f sum = octave.surface.p_cam[voxel] * (peak - weakest);
    float total = peak - weakest;
    for (const auto i : around) {
        const float weight = response(i) - weakest;
        sum += weight * octave.surface.p_cam[i];
        total += weight;
    }
    return total != 0.0F ? Eigen::Vector3f(sum / total) : octave.surface.p_cam[voxel];
}

bool is_extremum(const SurfaceOctave& octave, std::uint32_t voxel, std::size_t layer) {
    const Differences own{&octave.blurred[voxel * kLanes]};
    const float peak = own[layer];
    const float sign = peak > 0.0F ? 1.0F : -1.0F;
    const auto beats = [&](float other) {
        return sign * peak > sign * other;
    };
    if (!beats(own[layer - 1]) || !beats(own[layer + 1])) return false;
    for (const auto i : octave.neighbours.of(voxel)) {
        const Differences other{&octave.blurred[i * kLanes]};
        if (!beats(other[layer]) || !beats(other[layer - 1]) || !beats(other[layer + 1]))
            return false;
    }
    return true;
}

}  // namespace

std::vector<Keypoint3d> sift3d_keypoints(
    std::span<const SurfaceOctave> octaves, const Sift3dSettings& settings
) {
    std::vector<Keypoint3d> keypoints;
    for (std::size_t o = 0; o < octaves.size(); ++o) {
        const SurfaceOctave& octave = octaves[o];
        for (std::uint32_t voxel = 0; voxel < octave.surface.size(); ++voxel) {
            const Differences own{&octave.blurred[voxel * kLanes]};
            if (octave.neighbours.counts[voxel] < kFewestNeighbours) continue;
            for (int layer = 1; layer <= settings.scales_per_octave; ++layer) {
                const auto at = static_cast<std::size_t>(layer);
                if (std::abs(own[at]) < settings.least_contrast || !is_extremum(octave, voxel, at))
                    continue;
                keypoints.push_back(
                    {refined_place(octave, voxel, at),
                     octave.surface.voxel_m * sigma_of(layer, settings.scales_per_octave),
                     own[at],
                     static_cast<std::uint8_t>(o),
                     static_cast<std::uint8_t>(layer),
                     voxel}
                );
            }
        }
    }
    return keypoints;
}

}  // namespace kinectlab
