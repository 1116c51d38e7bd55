#include "pipeline/simulate/scene.hpp"

#include <cmath>

namespace kinectlab::simulate {
namespace {

constexpr double kTableThickness = 0.04;
constexpr double kLegWidth = 0.06;
constexpr double kMountHalfWidth = 0.015;
constexpr double kBaseline = 0.025;  ///< colour camera to the right of the depth camera

void keep_nearest(Hit& nearest, double t, const Eigen::Vector3d& normal, Material material) {
    if (t > 1e-9 && t < nearest.t) nearest = {t, normal, material};
}

void hit_box(
    const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& nearest
) {
    if (const auto entry = enter_box(box.low, box.high, origin, direction))
        keep_nearest(
            nearest, entry->t, entry->sign * Eigen::Vector3d::Unit(entry->axis), box.material
        );
}

void hit_block(
    const Block& block,
    const Eigen::Vector3d& origin,
    const Eigen::Vector3d& direction,
    Hit& nearest
) {
    const Eigen::Matrix3d& R = block.T_lab_block.linear();
    const Eigen::Vector3d from = R.transpose() * (origin - block.T_lab_block.translation());
    const Eigen::Vector3d half = 0.5 * block.size_m;
    if (const auto entry = enter_box(-half, half, from, R.transpose() * direction))
        keep_nearest(nearest, entry->t, entry->sign * R.col(entry->axis), block.material);
}

Box leg(double x, double y) {
    const Eigen::Vector3d half(0.5 * kLegWidth, 0.5 * kLegWidth, 0.0);
    const double height = room::kTableTop - kTableThickness;
    return {
        Eigen::Vector3d(x, y, 0.0) - half,
        Eigen::Vector3d(x, y, height) + half,
        Material::table_leg};
}

}  // namespace

/// Slab method; the entry face's normal points against the ray.
std::optional<Entry> enter_box(
    const Eigen::Vector3d& low,
    const Eigen::Vector3d& high,
    const Eigen::Vector3d& origin,
    const Eigen::Vector3d& direction
) {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    int axis = 0;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(direction[i]) < 1e-12) {
            if (origin[i] < low[i] || origin[i] > high[i]) return std::nullopt;
            continue;
        }
        const double a = (low[i] - origin[i]) / direction[i];
        const double b = (high[i] - origin[i]) / direction[i];
        if (std::min(a, b) > enter) {
            enter = std::min(a, b);
            axis = i;
        }
        leave = std::min(leave, std::max(a, b));
    }
    if (enter > leave) return std::nullopt;
    return Entry{enter, axis, direction[axis] > 0.0 ? -1.0 : 1.0};
}

Room::Room(const Furniture& furniture) : has_table_(furniture.table), blocks_(furniture.blocks) {
    const double x = room::kTableHalfX;
    const double y = room::kTableHalfY;
    const double leg_x = x - 0.08;
    const double leg_y = y - 0.06;
    const double m = kMountHalfWidth;
    if (furniture.table)
        boxes_ = {
            Box{{-x, -y, room::kTableTop - kTableThickness},
                {x, y, room::kTableTop},
                Material::table},
            leg(-leg_x, -leg_y),
            leg(leg_x, -leg_y),
            leg(-leg_x, leg_y),
            leg(leg_x, leg_y),
        };
    if (const auto end = furniture.mount_from_m)
        boxes_.push_back({{-m, -m, *end}, {m, m, *end + 4.0}, Material::mount});
    boxes_.push_back(
        {{-2.3, 1.2, 0.0}, {-1.25, room::kWallY, room::kTallestFurniture}, Material::cabinet}
    );
    boxes_.push_back({{1.55, 1.3, 0.0}, {2.4, room::kWallY, 0.8}, Material::cabinet});
}

Room::Room(double pivot_height_m) : Room(Furniture{true, pivot_height_m, {}}) {}

Hit Room::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    Hit nearest;
    if (direction.y() > 1e-12)
        keep_nearest(
            nearest,
            (room::kWallY - origin.y()) / direction.y(),
            -Eigen::Vector3d::UnitY(),
            Material::wall
        );
    if (direction.z() < -1e-12)
        keep_nearest(
            nearest, -origin.z() / direction.z(), Eigen::Vector3d::UnitZ(), Material::floor
        );
    for (const Box& box : boxes_)
        hit_box(box, origin, direction, nearest);
    for (const Block& block : blocks_)
        hit_block(block, origin, direction, nearest);
    return nearest;
}

bool Room::hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    Hit nearest;
    const Eigen::Vector3d direction = to - from;
    for (const Box& box : boxes_)
        if (box.material != Material::mount && from.z() < box.high.z())
            hit_box(box, from + 1e-4 * direction, direction, nearest);
    for (const Block& block : blocks_)
        hit_block(block, from + 1e-4 * direction, direction, nearest);
    return nearest.t < 1.0;
}

Eigen::Vector3d pivot_of(double length_m) {
    return {0.0, 0.0, room::kBobRestHeight + length_m};
}

Eigen::Isometry3d T_lab_cam_of(const CameraPlacement& placement) {
    Eigen::Matrix3d level;  // x right = x, y down = -z, z forward = y
    level << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    Eigen::Isometry3d T_lab_cam = Eigen::Isometry3d::Identity();
    T_lab_cam.linear() =
        level * Eigen::AngleAxisd(-placement.tilt_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
    T_lab_cam.translation() = Eigen::Vector3d(0.0, -placement.distance_m, placement.height_m);
    return T_lab_cam;
}

RgbdCamera kinect_camera() {
    RgbdCamera camera;
    camera.depth = {640, 480, 580.0, 580.0, 319.5, 239.5};
    camera.colour = {640, 480, 525.0, 525.0, 319.5, 239.5};
    camera.T_colour_depth.translation() = Eigen::Vector3d(-kBaseline, 0.0, 0.0);
    return camera;
}

}  // namespace kinectlab::simulate
