#include "pipeline/preprocess/octree_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/number_text.hpp"
#include "pipeline/core/vector8.hpp"
#include "pipeline/preprocess/voxel_counts.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

constexpr std::size_t kBatch = 512;
constexpr double kMostCells = 1 << OctreeBox::kMostDepth;

/// The cells of a batch of points: structure of arrays; kNoCell where there is no reading.
struct Cells {
    std::array<std::int32_t, kBatch> x, y, z;
};
constexpr std::int32_t kNoCell = std::numeric_limits<std::int32_t>::min();

/// The box about a batch's readings that are whole: x, y and z.
struct alignas(32) Reach {
    std::array<float, 3> low, high;
};

KINECTLAB_HOT_LOOP void reach_of(
    const float* x, const float* y, const float* z, std::size_t n, Reach& reach
) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Float8 low[3] = {all8(kInfinity), all8(kInfinity), all8(kInfinity)};
    Float8 high[3] = {-low[0], -low[1], -low[2]};
    const auto add = [&](const Float8& a, const Float8& b, const Float8& c) {
        const Float8 whole = (a - a) + (b - b) + (c - c);  // 0, or NaN, which is neither < nor >
        const Float8 point[3] = {a + whole, b + whole, c + whole};
        for (int k = 0; k < 3; ++k) {
            low[k] = choose8(point[k] < low[k], point[k], low[k]);
            high[k] = choose8(point[k] > high[k], point[k], high[k]);
        }
    };
    std::size_t i = 0;
    for (; i + 8 <= n; i += 8)
        add(load8(x + i), load8(y + i), load8(z + i));
    for (; i < n; ++i)
        add(all8(x[i]), all8(y[i]), all8(z[i]));
    for (std::size_t k = 0; k < 3; ++k) {
        reach.low[k] = kInfinity;
        reach.high[k] = -kInfinity;
        for (int lane = 0; lane < 8; ++lane) {
            reach.low[k] = std::min(reach.low[k], low[k][lane]);
            reach.high[k] = std::max(reach.high[k], high[k][lane]);
        }
    }
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

KINECTLAB_HOT_LOOP void mark_holes(
    const float* x, const float* y, const float* z, std::size_t n, std::int32_t* cells
) {
    for (std::size_t i = 0; i < n; ++i) {
        const float whole = (x[i] - x[i]) + (y[i] - y[i]) + (z[i] - z[i]);
        cells[i] = whole == 0.0F ? cells[i] : kNoCell;
    }
}

Error too_wide(const Cloud& cloud, std::size_t i, double voxel_m) {
    return {
        ErrorCode::invalid_argument,
        "voxel_m",
        "is " + number_text(voxel_m) + " m, which is too fine for a cloud that reaches (" +
            number_text(cloud.x[i]) + ", " + number_text(cloud.y[i]) + ", " +
            number_text(cloud.z[i]) + ") m",
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
        mark_holes(
            cloud.x.data() + first,
            cloud.y.data() + first,
            cloud.z.data() + first,
            n,
            cells.x.data()
        );
        visit(first, n, cells);
    };
    for (std::size_t first = 0; first < cloud.size(); first += kBatch) {
        const std::size_t n = std::min(kBatch, cloud.size() - first);
        Reach reach;
        reach_of(cloud.x.data() + first, cloud.y.data() + first, cloud.z.data() + first, n, reach);
        const auto& [low, high] = reach;
        if (low[0] > high[0]) continue;  // nothing but holes
        if (box.holds(low[0], low[1], low[2]) && box.holds(high[0], high[1], high[2])) {
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

/// Points in new voxels.
struct NewPoints {
    std::vector<std::array<std::int32_t, 3>> cells;
    std::vector<std::size_t> points;
};

/// Leaves only points that share their voxel with enough others.
void drop_sparse(const NewPoints& found, int least_points, OctreeChange& change) {
    VoxelCounts counts(found.points.size());
    std::vector<std::uint32_t> places;
    places.reserve(found.points.size());
    for (const auto& [x, y, z] : found.cells)
        places.push_back(counts.add(x, y, z));
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (counts.points_at(places[k]) >= least_points) continue;
        change.mask[found.points[k]] = 0;
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
            "is " + number_text(voxel_m),
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
    NewPoints found;
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
                found.cells.push_back({x, y, z});
                found.points.push_back(first + i);
            }
        }
    };
    if (auto done = for_cells(cloud, box, compare); !done) return tl::unexpected(done.error());
    if (least_points > 1) drop_sparse(found, least_points, change);
    return change;
}

}  // namespace kinectlab
