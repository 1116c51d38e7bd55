#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/simulate/body.hpp"

namespace kinectlab::simulate {

/// Where the Kinect stands: in front of the swing plane, looking along +y.
struct CameraPlacement {
    double distance_m = 1.6;  ///< depth camera to the plane y = 0
    double height_m = 1.15;   ///< above the floor
    double tilt_rad = 0.0;    ///< positive looks down
};

/// The laboratory in the lab frame: origin on the floor below the pivot, x east along the main
/// motion, y north (away from the camera), z up; metres.
namespace room {
constexpr double kBobRestHeight = 0.9;
constexpr double kWallY = 1.6;
constexpr double kTableTop = 0.74;
constexpr double kTableHalfX = 0.95;
constexpr double kTableHalfY = 0.40;
constexpr double kTallestFurniture = 1.02;
constexpr double kStringRadius = 0.001;
}  // namespace room

struct Hit {
    double t =
        std::numeric_limits<double>::infinity();  ///< along the ray, in lengths of its direction
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    Material material = Material::none;
};

struct Box {
    Eigen::Vector3d low, high;
    Material material;
};

/// A box that stands still, its edges along its own axes, its centre at its origin.
struct Block {
    Eigen::Isometry3d T_lab_block = Eigen::Isometry3d::Identity();
    Eigen::Vector3d size_m = Eigen::Vector3d::Constant(0.1);
    Material material = Material::mount;
};

/// What an apparatus makes of the room.
struct Furniture {
    bool table = true;
    std::optional<double> mount_from_m;  ///< a rod comes from the ceiling down to this height
    std::vector<Block> blocks;
};

/// Everything that stands still.
class Room {
public:
    explicit Room(const Furniture& furniture);

    /// With the table, below a rod that ends at this height.
    explicit Room(double pivot_height_m);

    /// Nearest surface in front of `origin`; Material::none if there is none.
    [[nodiscard]] Hit cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

    /// True if furniture stands between the two points; the thin mount does not count.
    [[nodiscard]] bool hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

    [[nodiscard]] bool has_table() const { return has_table_; }

private:
    bool has_table_;
    std::vector<Box> boxes_;
    std::vector<Block> blocks_;
};

/// Where a ray enters a box whose edges lie along the axes: in lengths of its direction, and
/// through which face; also behind the origin. None if it passes by.
struct Entry {
    double t;
    int axis;
    double sign;  ///< of the face's outward normal along the axis
};
[[nodiscard]] std::optional<Entry> enter_box(
    const Eigen::Vector3d& low,
    const Eigen::Vector3d& high,
    const Eigen::Vector3d& origin,
    const Eigen::Vector3d& direction
);

/// Pivot of a pendulum of this length, so that the bob rests at kBobRestHeight.
[[nodiscard]] Eigen::Vector3d pivot_of(double length_m);

/// Depth camera → lab.
[[nodiscard]] Eigen::Isometry3d T_lab_cam_of(const CameraPlacement& placement);

/// The simulated Kinect: f = 580 px for depth, 525 px for colour, 2.5 cm to the right of it.
[[nodiscard]] RgbdCamera kinect_camera();

}  // namespace kinectlab::simulate
