#include "pipeline/track/patch_table.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/track/model_view.hpp"

namespace kinectlab {
namespace {

constexpr double kTypicalDistance = 1.0;  // m
constexpr double kLeastRadii = 5.0;       // distance in radii of the object, for large ones
constexpr double kViewUnit = 1e-4;        // m for each count of a drawn depth picture
constexpr std::size_t kPointsAView = 96;
constexpr std::size_t kOutsideAView = 48;
constexpr double kOutsideRadii = 0.12;  // from the outline
constexpr float kSpreadScale = 3.0F;    // the spread of a share is at most one half

/// The camera's own optics, with a picture that just holds the object.
RgbdCamera view_camera(const RgbdCamera& camera, double radius_m, double distance_m) {
    RgbdCamera view = camera;
    const int side =
        2 * static_cast<int>(1.1 * camera.depth.fx * radius_m / (distance_m - radius_m)) + 16;
    view.depth.width = view.depth.height = std::min(side, 900);
    view.depth.cx = view.depth.cy = (view.depth.width - 1) / 2.0;
    view.depth.fy = view.depth.fx;
    view.depth_unit_m = kViewUnit;
    return view;
}

Eigen::Isometry3d look_along(const Eigen::Vector3d& direction, double distance_m) {
    const Eigen::Vector3d up =
        std::abs(direction.y()) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d x = up.cross(direction).normalized();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear().row(0) = x;
    T.linear().row(1) = direction.cross(x);
    T.linear().row(2) = direction;
    T.translation() = Eigen::Vector3d(0.0, 0.0, distance_m);
    return T;
}

std::vector<std::uint16_t> depth_picture(const ModelViewer::Picture& drawn, const Pinhole& camera) {
    std::vector<std::uint16_t> depth(static_cast<std::size_t>(camera.width * camera.height), 0);
    for (int v = 0; v < drawn.height; ++v)
        for (int u = 0; u < drawn.width; ++u) {
            const float inverse = drawn.inverse[static_cast<std::size_t>(v * drawn.width + u)];
            if (inverse <= 0.0F) continue;
            const double counts = 1.0 / (static_cast<double>(inverse) * kViewUnit) + 0.5;
            if (counts < 65535.0)
                depth[static_cast<std::size_t>((drawn.top + v) * camera.width + drawn.left + u)] =
                    static_cast<std::uint16_t>(counts);
        }
    return depth;
}

SketchView sketch_of(
    const ModelView& seen, const Eigen::Isometry3d& T_cam_obj, double radius_m, std::mt19937& random
) {
    SketchView view;
    view.R_cam_obj = T_cam_obj.linear().cast<float>();
    for (const auto& point : seen.surface)
        view.surface.push_back({point.p_obj.cast<float>(), point.n_obj.cast<float>()});
    std::shuffle(view.surface.begin(), view.surface.end(), random);
    for (const auto& point : seen.outline) {
        const Eigen::Vector3d outwards(point.outwards.x(), point.outwards.y(), 0.0);
        const Eigen::Vector3d away = T_cam_obj.linear().transpose() * outwards;
        view.outside.emplace_back((point.p_obj + kOutsideRadii * radius_m * away).cast<float>());
    }
    return view;
}

void to_model_frame(SurfacePatch& patch, const Eigen::Isometry3d& T_obj_cam) {
    patch.keypoint.p_cam = T_obj_cam * patch.keypoint.p_cam;
    patch.keypoint.normal = T_obj_cam.linear() * patch.keypoint.normal;
    patch.keypoint.direction = T_obj_cam.linear() * patch.keypoint.direction;
    patch.centroid_cam = T_obj_cam * patch.centroid_cam;
}

}  // namespace

std::vector<Eigen::Vector3d> view_directions() {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    std::vector<Eigen::Vector3d> corners;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-g, g}) {
            corners.emplace_back(0.0, a, b);
            corners.emplace_back(a, b, 0.0);
            corners.emplace_back(b, 0.0, a);
        }
    std::vector<Eigen::Vector3d> directions;
    for (const auto& corner : corners)
        directions.push_back(corner.normalized());
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if ((corners[i] - corners[j]).norm() < 2.1)  // an edge is 2 long
                directions.push_back((corners[i] + corners[j]).normalized());
    return directions;
}

PatchTable::PatchTable(
    const RgbdCamera& camera,
    const ObjectModel& model,
    const PatchSettings& settings,
    std::mt19937& random
)
    : cells_(static_cast<std::size_t>(kSurfaceTypes * kCells * kCells)) {
    const double distance_m = std::max(kTypicalDistance, kLeastRadii * model.radius_m);
    const RgbdCamera own = view_camera(camera, model.radius_m, distance_m);
    ModelViewer viewer(own.depth, {kPointsAView, kOutsideAView, 1'000'000});
    // Where a cloud's scan ended the object may go on, but not all around it.
    ObjectModel outlined = model;
    outlined.has_outline = true;
    for (const auto& direction : view_directions()) {
        const Eigen::Isometry3d T_cam_obj = look_along(direction, distance_m);
        const ModelView& seen = viewer.look(outlined, T_cam_obj);
        views_.push_back(sketch_of(seen, T_cam_obj, model.radius_m, random));
        const auto depth = depth_picture(viewer.picture(), own.depth);
        for (auto& patch : find_surface_patches(depth, own, settings)) {
            to_model_frame(patch, T_cam_obj.inverse());
            patches_.push_back({patch, static_cast<std::uint32_t>(views_.size() - 1)});
        }
    }
    for (std::uint32_t i = 0; i < patches_.size(); ++i) {
        const SurfacePatch& patch = patches_[i].patch;
        const auto at =
            key(patch.type, cell_of(patch.mean_index), cell_of(kSpreadScale * patch.index_spread));
        cells_[at].push_back(i);
    }
}

std::vector<const ModelPatch*> PatchTable::look_up(
    const SurfacePatch& patch, std::size_t most, double most_distance
) const {
    std::vector<std::pair<double, const ModelPatch*>> near;
    const int mean = cell_of(patch.mean_index), spread = cell_of(kSpreadScale * patch.index_spread);
    for (int m = std::max(0, mean - 1); m <= std::min(kCells - 1, mean + 1); ++m)
        for (int s = std::max(0, spread - 1); s <= std::min(kCells - 1, spread + 1); ++s)
            for (const auto i : cells_[key(patch.type, m, s)]) {
                const double distance = patch_distance(patch, patches_[i].patch);
                if (distance <= most_distance) near.emplace_back(distance, &patches_[i]);
            }
    const auto nearer = [](const auto& a, const auto& b) {
        return a.first < b.first;
    };
    const std::size_t kept = std::min(most, near.size());
    std::partial_sort(
        near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), near.end(), nearer
    );
    std::vector<const ModelPatch*> best;
    best.reserve(kept);
    for (std::size_t i = 0; i < kept; ++i)
        best.push_back(near[i].second);
    return best;
}

}  // namespace kinectlab
