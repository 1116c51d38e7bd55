#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "pipeline/simulate/scene.hpp"

namespace kinectlab::simulate {

/// Linear red, green, blue; 1 is a white surface in full light.
using Radiance = Eigen::Vector3f;

/// The light that falls on a surface, apart for what a shadow takes away and what it leaves.
struct Irradiance {
    Radiance direct = Radiance::Zero();   ///< from the lamp, unhidden
    Radiance ambient = Radiance::Zero();  ///< from the room
};

/// A square lamp under the ceiling.
constexpr double kLampHalfSize = 0.28;
[[nodiscard]] Eigen::Vector3d lamp_centre();

[[nodiscard]] Irradiance irradiance(const Eigen::Vector3d& p_lab, const Eigen::Vector3d& normal);

/// What part of light a clean surface sends back, with the pattern that the material has there.
[[nodiscard]] Radiance albedo(
    Material material, const Eigen::Vector3d& p_lab, const Eigen::Vector3d& normal
);

/// A point of the room as seen from `eye`; `grain` chooses which points of the lamp are tried.
[[nodiscard]] Radiance shade_room(
    const Room& room,
    const Hit& hit,
    const Eigen::Vector3d& p_lab,
    const Eigen::Vector3d& eye,
    std::uint64_t grain
);

/// The paint of a moving body at a place of its own frame, on the side that its normal tells.
[[nodiscard]] Radiance paint_of(
    Material material, const Eigen::Vector3d& p_body, const Eigen::Vector3d& normal_body
);

/// A painted surface under varnish; gloss 1 mirrors as a polished ball does, 0 not at all.
[[nodiscard]] Radiance shade_body(
    const Radiance& paint,
    double gloss,
    const Eigen::Vector3d& p_lab,
    const Eigen::Vector3d& normal,
    const Eigen::Vector3d& eye
);

/// What a ball's shadow leaves of the light on an upward surface, 0 to 1.
[[nodiscard]] float light_left_by(
    const Eigen::Vector3d& centre_lab, double radius_m, const Eigen::Vector3d& p_lab
);

[[nodiscard]] std::uint8_t to_srgb(float linear);
[[nodiscard]] float from_srgb(std::uint8_t value);

}  // namespace kinectlab::simulate
