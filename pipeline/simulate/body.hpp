#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

namespace kinectlab::simulate {

enum class Material {
    none,
    wall,
    floor,
    table,
    table_leg,
    cabinet,
    mount,
    plank,
    sand,
    bob,  ///< red, as bodies are painted from here on
    blue_ball,
    yellow_ball,
    striped_ball,  ///< shows how it turns
    painted_box,   ///< six hues with a pattern of small squares, so that each face has texture
    string,
};

struct Sphere {
    double radius_m = 0.05;
};

/// A box centred on the body's origin, edges along its axes.
struct Cuboid {
    Eigen::Vector3d size_m = Eigen::Vector3d::Constant(0.1);
};

using Shape = std::variant<Sphere, Cuboid>;

/// A rigid body where it is now; its frame begins at its centre.
struct Body {
    std::string name;
    Shape shape;
    Material material = Material::bob;
    Eigen::Vector3d p_lab = Eigen::Vector3d::Zero();                 ///< m
    Eigen::Quaterniond q_lab_body = Eigen::Quaterniond::Identity();  ///< body → lab
    Eigen::Vector3d v_lab = Eigen::Vector3d::Zero();                 ///< of the centre, m/s
    Eigen::Vector3d w_lab = Eigen::Vector3d::Zero();                 ///< rad/s
};

/// A thin straight string from `from` to `to`; drawn where the first end is above the second.
struct Wire {
    Eigen::Vector3d from_lab = Eigen::Vector3d::Zero();
    Eigen::Vector3d to_lab = Eigen::Vector3d::Zero();
};

/// All that may look different in the next picture.
struct MovingParts {
    std::vector<Body> bodies;
    std::vector<Wire> wires;
};

/// Radius of the sphere about the centre that holds the body.
[[nodiscard]] double reach_of(const Shape& shape);

/// Radius of a ball of the same volume, m.
[[nodiscard]] double ball_radius_of(const Shape& shape);

}  // namespace kinectlab::simulate
