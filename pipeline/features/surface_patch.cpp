#include "pipeline/features/surface_patch.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr int kWindow = 2;  // nodes to either side that a keypoint must outdo
constexpr double kCurvedSigmas = 3.0;
constexpr double kHalfDrawn = 8.0;  // 1/m: curvedness whose index counts for one half

/// Curvatures on a grid of every n-th pixel.
struct Grid {
    int width = 0, height = 0, step = 1;
    std::vector<CurvedPoint> points;
    std::vector<float> index;  // shape index, drawn towards 1/2; NaN where there is no surface

    [[nodiscard]] std::size_t at(int i, int j) const {
        return static_cast<std::size_t>(j * width + i);
    }
    [[nodiscard]] bool has(int i, int j) const {
        return i >= 0 && j >= 0 && i < width && j < height && !std::isnan(index[at(i, j)]);
    }
};

double median_depth(std::span<const std::uint16_t> depth, double unit_m) {
    std::vector<std::uint16_t> some;
    for (std::size_t i = 0; i < depth.size(); i += 37)
        if (depth[i] != 0) some.push_back(depth[i]);
    if (some.empty()) return 0.0;
    std::nth_element(
        some.begin(), some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2), some.end()
    );
    return unit_m * some[some.size() / 2];
}

Grid look(
    std::span<const std::uint16_t> depth, const RgbdCamera& camera, const PatchSettings& settings
) {
    Grid grid;
    const double z = median_depth(depth, camera.depth_unit_m);
    if (z == 0.0) return grid;
    grid.step =
        std::clamp(static_cast<int>(settings.fit_radius_m * camera.depth.fx / z / 3.0 + 0.5), 2, 8);
    grid.width = camera.depth.width / grid.step;
    grid.height = camera.depth.height / grid.step;
    const auto nodes = static_cast<std::size_t>(grid.width * grid.height);
    grid.points.resize(nodes);
    grid.index.assign(nodes, std::numeric_limits<float>::quiet_NaN());
    const DisparityScale scale(camera);
    for (int j = 0; j < grid.height; ++j) {
        for (int i = 0; i < grid.width; ++i) {
            const auto point = curved_point(
                depth,
                camera.depth,
                scale,
                i * grid.step + grid.step / 2,
                j * grid.step + grid.step / 2,
                settings.fit_radius_m
            );
            if (!point) continue;
            grid.points[grid.at(i, j)] = *point;
            const double curved = point->curvedness();
            grid.index[grid.at(i, j)] = static_cast<float>(
                0.5 + (point->shape_index() - 0.5) * curved / (curved + kHalfDrawn)
            );
        }
    }
    return grid;
}

/// The paper's criterion: S is a local maximum above (1 + α) of the mean, or a minimum below
/// (1 - β) of it; and the surface is curved beyond doubt.
bool is_keypoint(const Grid& grid, int i, int j, const PatchSettings& settings) {
    if (!grid.has(i, j)) return false;
    const CurvedPoint& point = grid.points[grid.at(i, j)];
    if (point.curvedness() < kCurvedSigmas * point.sigma_k) return false;
    const float own = grid.index[grid.at(i, j)];
    double sum = 0.0;
    int count = 0;
    bool highest = true, lowest = true;
    for (int dj = -kWindow; dj <= kWindow; ++dj)
        for (int di = -kWindow; di <= kWindow; ++di) {
            if (!grid.has(i + di, j + dj)) continue;
            const float other = grid.index[grid.at(i + di, j + dj)];
            sum += other;
            ++count;
            if (std::abs(di) <= 1 && std::abs(dj) <= 1) {
                highest = highest && other <= own;
                lowest = lowest && other >= own;
            }
        }
    const double mean = sum / count;
    return count >= 8 && ((highest && own > (1.0 + settings.alpha) * mean) ||
                          (lowest && own < (1.0 - settings.beta) * mean));
}

SurfacePatch describe(const Grid& grid, int i, int j, double fx, const PatchSettings& settings) {
    SurfacePatch patch;
    patch.keypoint = grid.points[grid.at(i, j)];
    patch.type = surface_type(patch.keypoint);
    const int reach = std::clamp(
        static_cast<int>(settings.patch_radius_m * fx / patch.keypoint.p_cam.z() / grid.step), 1, 24
    );
    const double radius2 = settings.patch_radius_m * settings.patch_radius_m;
    double sum = 0.0, squares = 0.0, total = 0.0;
    for (int dj = -reach; dj <= reach; ++dj) {
        for (int di = -reach; di <= reach; ++di) {
            if (!grid.has(i + di, j + dj)) continue;
            const auto at = grid.at(i + di, j + dj);
            const CurvedPoint& other = grid.points[at];
            if ((other.p_cam - patch.keypoint.p_cam).squaredNorm() > radius2) continue;
            const double index = grid.index[at];
            const double angle =
                std::acos(std::clamp(other.normal.dot(patch.keypoint.normal), -1.0, 1.0));
            // Shared among the neighbouring bins, so that a little noise changes little.
            const double x = std::clamp(index, 0.0, 1.0) * (SurfacePatch::kIndexBins - 1);
            const double y = std::min(angle / (0.5 * M_PI), 1.0) * (SurfacePatch::kAngleBins - 1);
            const int bx = std::min(static_cast<int>(x), SurfacePatch::kIndexBins - 2);
            const int by = std::min(static_cast<int>(y), SurfacePatch::kAngleBins - 2);
            for (int ox = 0; ox < 2; ++ox)
                for (int oy = 0; oy < 2; ++oy) {
                    const double weight =
                        (ox == 0 ? bx + 1 - x : x - bx) * (oy == 0 ? by + 1 - y : y - by);
                    patch.histogram[static_cast<std::size_t>(
                        (by + oy) * SurfacePatch::kIndexBins + bx + ox
                    )] += static_cast<float>(weight);
                }
            patch.centroid_cam += other.p_cam;
            sum += index;
            squares += index * index;
            total += 1.0;
        }
    }
    for (auto& bin : patch.histogram)
        bin /= static_cast<float>(total);
    patch.centroid_cam /= total;
    patch.mean_index = static_cast<float>(sum / total);
    patch.index_spread =
        static_cast<float>(std::sqrt(std::max(0.0, squares / total - sum * sum / (total * total))));
    return patch;
}

}  // namespace

std::vector<SurfacePatch> find_surface_patches(
    std::span<const std::uint16_t> depth, const RgbdCamera& camera, const PatchSettings& settings
) {
    const Grid grid = look(depth, camera, settings);
    std::vector<SurfacePatch> patches;
    for (int j = 0; j < grid.height; ++j)
        for (int i = 0; i < grid.width; ++i)
            if (is_keypoint(grid, i, j, settings))
                patches.push_back(describe(grid, i, j, camera.depth.fx, settings));
    std::sort(patches.begin(), patches.end(), [](const SurfacePatch& a, const SurfacePatch& b) {
        return a.keypoint.curvedness() > b.keypoint.curvedness();
    });
    if (patches.size() > settings.most_patches) patches.resize(settings.most_patches);
    return patches;
}

double patch_distance(const SurfacePatch& a, const SurfacePatch& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.histogram.size(); ++i) {
        const double both = a.histogram[i] + b.histogram[i];
        const double off = a.histogram[i] - b.histogram[i];
        if (both > 0.0) sum += off * off / both;
    }
    return 0.5 * sum;
}

}  // namespace kinectlab
