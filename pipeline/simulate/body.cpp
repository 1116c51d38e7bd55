#include "pipeline/simulate/body.hpp"

#include <cmath>
#include <numbers>

namespace kinectlab::simulate {

double reach_of(const Shape& shape) {
    if (const auto* box = std::get_if<Cuboid>(&shape)) return 0.5 * box->size_m.norm();
    return std::get<Sphere>(shape).radius_m;
}

double ball_radius_of(const Shape& shape) {
    if (const auto* box = std::get_if<Cuboid>(&shape))
        return std::cbrt(box->size_m.prod() * 0.75 / std::numbers::pi);
    return std::get<Sphere>(shape).radius_m;
}

}  // namespace kinectlab::simulate
