#include "pipeline/preprocess/octree_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kBatch = 512;
constexpr double kMostCells = 1 << OctreeBox::kMostDepth;

/// The cells of a batch of points: structure of arrays; kNoCell where there is no reading.
struct Cells {
    std::array<std::int32_t, kBatch> x, y, z;
};
constexpr std::int32_t kNoCell = std::numeric_limits<std::int32_t>::min();

struct Range {
    float low, high;
};

/// Least and greatest of the readings that are whole.
KINECTLAB_HOT_LOOP Range range_of(const float* a, const float* b, const float* c, std::size_t n) {
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (std::size_t i = 0; i < n; ++i) {
        const float whole = (a[i] - a[i]) + (b[i] - b[i]) + (c[i] - c[i]);  // 0, or NaN
        const float value = a[i] + whole;
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    return {low, high};
}

KINECTLAB_HOT_LOOP void cells_along(
    const float* values,
    std::size_t n,
    double low,
    double voxel_m,
    std::int32_t origin,
    std::int32_t* cells
) {
    for (std::size_t i = 0; i < n; ++i) {
        const double place = (values[i] - low) / voxel_m;
        const double inside = place > 0.0 ? (place < kMostCells ? place : kMostCells) : 0.0;  // NaN
        cells[i] = origin + static_cast<std::int32_t>(inside);
    }
}

Error too_wide(const Cloud& cloud, std::size_t i, double voxel_m) {
    return {
        ErrorCode::invalid_argument,
        "voxel_m",
        "is " + std::to_string(voxel_m) + " m, which is too fine for a cloud that reaches (" +
            std::to_string(cloud.x[i]) + ", " + std::to_string(cloud.y[i]) + ", " +
            std::to_string(cloud.z[i]) + ") m",
        "give larger voxels, or leave out points that far away"};
}

/// Calls visit(first, count, cells) for one batch of points after the other. A batch that the box
/// holds is converted at once; where the box must grow, its points come one by one, because cells
/// round from the box as it is when the point comes.
template <class Visit>
Result<void> for_cells(const Cloud& cloud, OctreeBox& box, Visit&& visit) {
    Cells cells;
    const auto convert = [&](std::size_t first, std::size_t n) {
        const auto& low = box.low();
        const auto& origin = box.origin();
        const double voxel = box.voxel_m();
        cells_along(cloud.x.data() + first, n, low[0], voxel, origin[0], cells.x.data());
        cells_along(cloud.y.data() + first, n, low[1], voxel, origin[1], cells.y.data());
        cells_along(cloud.z.data() + first, n, low[2], voxel, origin[2], cells.z.data());
        for (std::size_t i = 0; i < n; ++i)
            if (!cloud.valid(first + i)) cells.x[i] = kNoCell;
        visit(first, n, cells);
    };
    for (std::size_t first = 0; first < cloud.size(); first += kBatch) {
        const std::size_t n = std::min(kBatch, cloud.size() - first);
        const float* x = cloud.x.data() + first;
        const float* y = cloud.y.data() + first;
        const float* z = cloud.z.data() + first;
        const Range in_x = range_of(x, y, z, n);
        const Range in_y = range_of(y, z, x, n);
        const Range in_z = range_of(z, x, y, n);
        if (in_x.low > in_x.high) continue;  // nothing but holes
        if (box.holds(in_x.low, in_y.low, in_z.low) && box.holds(in_x.high, in_y.high, in_z.high)) {
            convert(first, n);
            continue;
        }
        for (std::size_t i = first; i < first + n; ++i) {
            if (!cloud.valid(i)) continue;
            if (!box.grow_to(cloud.x[i], cloud.y[i], cloud.z[i]))
                return tl::unexpected(too_wide(cloud, i, box.voxel_m()));
            convert(i, 1);
        }
    }
    return {};
}

/// Leaves only points that share their voxel with enough others.
void drop_sparse(
    const std::vector<std::array<std::int32_t, 3>>& cells,
    const std::vector<std::size_t>& points,
    int least_points,
    OctreeChange& change
) {
    struct Hash {
        std::size_t operator()(const std::array<std::int32_t, 3>& cell) const {
            return VoxelSet::block_of(cell[0], cell[1], cell[2]) * 64 +
                   VoxelSet::bit_of(cell[0], cell[1], cell[2]);
        }
    };
    std::unordered_map<std::array<std::int32_t, 3>, int, Hash> number;
    for (const auto& cell : cells)
        ++number[cell];
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (number[cells[k]] >= least_points) continue;
        change.mask[points[k]] = 0;
        --change.count;
    }
}

}  // namespace

Result<OctreeReference> OctreeReference::of(const Cloud& reference, double voxel_m) {
    if (auto right = check_shape(reference); !right) return tl::unexpected(right.error());
    if (!std::isfinite(voxel_m) || voxel_m <= 0.0)
        return fail(
            ErrorCode::invalid_argument,
            "voxel_m",
            "is " + std::to_string(voxel_m),
            "give the edge of a voxel in metres, above 0, such as 0.02"
        );
    OctreeReference made(voxel_m);
    const auto inserted =
        for_cells(reference, made.box_, [&](std::size_t, std::size_t n, const Cells& cells) {
            for (std::size_t i = 0; i < n; ++i)
                if (cells.x[i] != kNoCell)
                    made.occupied_.insert(cells.x[i], cells.y[i], cells.z[i]);
        });
    if (!inserted) return tl::unexpected(inserted.error());
    return made;
}

Result<OctreeChange> OctreeReference::changed(const Cloud& cloud, int least_points) const {
    if (auto right = check_shape(cloud); !right) return tl::unexpected(right.error());
    if (least_points < 1)
        return fail(
            ErrorCode::invalid_argument,
            "least_points",
            "is " + std::to_string(least_points),
            "give the points that a voxel must hold, 1 or more"
        );
    OctreeChange change;
    change.mask.assign(cloud.size(), 0);
    std::vector<std::array<std::int32_t, 3>> new_cells;
    std::vector<std::size_t> new_points;
    OctreeBox box = box_;
    const auto compare = [&](std::size_t first, std::size_t n, const Cells& cells) {
        std::uint64_t block = 0;  // neighbours mostly lie in the block of the last point
        std::uint64_t word = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const std::int32_t x = cells.x[i], y = cells.y[i], z = cells.z[i];
            if (x == kNoCell) continue;
            if (const std::uint64_t at = VoxelSet::block_of(x, y, z); at != block) {
                block = at;
                word = occupied_.word(at);
            }
            if ((word >> VoxelSet::bit_of(x, y, z) & 1U) != 0) continue;
            change.mask[first + i] = 1;
            ++change.count;
            if (least_points > 1) {
                new_cells.push_back({x, y, z});
                new_points.push_back(first + i);
            }
        }
    };
    if (auto done = for_cells(cloud, box, compare); !done) return tl::unexpected(done.error());
    if (least_points > 1) drop_sparse(new_cells, new_points, least_points, change);
    return change;
}

}  // namespace kinectlab
