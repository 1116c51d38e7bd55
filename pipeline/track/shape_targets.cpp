#include <cmath>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/shape_detect.hpp"
#include "pipeline/track/shape_tracker.hpp"
#include "pipeline/track/sphere.hpp"

namespace kinectlab {
namespace {

SizeLimits limits_of(const auto& settings) {
    return {settings.radius_m, settings.min_radius_m, settings.max_radius_m};
}

struct ToTarget {
    std::optional<ShapeTarget> operator()(const SphereSettings& s) const {
        if (is_for_sphere_tracker(s)) return std::nullopt;
        return ShapeTarget{0, ShapeKind::sphere, limits_of(s), s.in, s.search};
    }
    std::optional<ShapeTarget> operator()(const PlaneSettings& s) const {
        if (!s.under.empty()) return std::nullopt;  // the carrying plane tracker's
        return ShapeTarget{0, ShapeKind::plane, {}, s.in, s.search};
    }
    std::optional<ShapeTarget> operator()(const CylinderSettings& s) const {
        return ShapeTarget{0, ShapeKind::cylinder, limits_of(s), s.in, GuessBy::ransac};
    }
    std::optional<ShapeTarget> operator()(const ConeSettings& s) const {
        return ShapeTarget{
            0,
            ShapeKind::cone,
            {s.half_angle_rad, kLeastConeAngle, kMostConeAngle},
            s.in,
            GuessBy::ransac};
    }
    template <class Other>
    std::optional<ShapeTarget> operator()(const Other&) const {
        return std::nullopt;
    }
};

Result<void> check_radius(const std::string& field, double radius_m) {
    if (std::isfinite(radius_m) && radius_m > 0.0 && radius_m <= 2.0) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is " + number_text(radius_m),
        "give a radius in metres above 0 and up to 2, e.g. 0.05"
    );
}

}  // namespace

std::vector<ShapeTarget> shape_targets(std::span<const ObjectSpec> objects) {
    std::vector<ShapeTarget> targets;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        auto target = std::visit(ToTarget{}, objects[i].settings);
        if (!target) continue;
        target->index = static_cast<std::uint32_t>(i);
        targets.push_back(*target);
    }
    return targets;
}

Result<void> check(const SphereSettings& settings, const std::string& path) {
    if (settings.radius_m) return check_radius(path + ".radius_m", *settings.radius_m);
    if (auto ok = check_radius(path + ".min_radius_m", settings.min_radius_m); !ok) return ok;
    if (auto ok = check_radius(path + ".max_radius_m", settings.max_radius_m); !ok) return ok;
    if (settings.min_radius_m < settings.max_radius_m) return {};
    return fail(
        ErrorCode::invalid_argument,
        path + ".min_radius_m",
        "is " + number_text(settings.min_radius_m) + ", not below max_radius_m " +
            number_text(settings.max_radius_m),
        "give a range, or radius_m alone"
    );
}

Result<void> check(const PlaneSettings&, const std::string&) {
    return {};
}

Result<void> check(const CylinderSettings& settings, const std::string& path) {
    // The same rules as for a ball.
    return check(
        SphereSettings{settings.radius_m, settings.min_radius_m, settings.max_radius_m}, path
    );
}

Result<void> check(const ConeSettings& settings, const std::string& path) {
    const double angle = settings.half_angle_rad.value_or(0.5);
    if (std::isfinite(angle) && angle >= kLeastConeAngle && angle <= kMostConeAngle) return {};
    return fail(
        ErrorCode::invalid_argument,
        path + ".half_angle_deg",
        "is " + number_text(angle) + " rad",
        "give 5° to 70° between the axis and the surface"
    );
}

}  // namespace kinectlab
