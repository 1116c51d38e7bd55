#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinectlab {

/// Where a shape is looked for: among what moved, or in the whole picture, moved or not.
enum class LookIn : std::uint8_t { moved, scene };

/// How a first guess of a shape is found: random minimal samples or votes of all points.
enum class GuessBy : std::uint8_t { ransac, hough };

/// Method "sphere": a ball.
struct SphereSettings {
    std::optional<double> radius_m;  ///< known radius; free if absent
    double min_radius_m = 0.01;      ///< where it is free
    double max_radius_m = 0.30;
    LookIn in = LookIn::moved;
    GuessBy search = GuessBy::ransac;
};

/// Method "plane": a board, a face of a box, a table; the biggest one if there are several.
struct PlaneSettings {
    LookIn in = LookIn::moved;
    GuessBy search = GuessBy::ransac;
};

/// Method "cylinder": a can, a pipe, a round rod, seen from outside.
struct CylinderSettings {
    std::optional<double> radius_m;  ///< known radius; free if absent
    double min_radius_m = 0.01;      ///< where it is free
    double max_radius_m = 0.30;
    LookIn in = LookIn::moved;
};

/// Method "cone": a whole one or a piece, seen from outside.
struct ConeSettings {
    std::optional<double> half_angle_rad;  ///< between axis and surface, if known
    LookIn in = LookIn::moved;
};

/// Method "change": whatever moved.
struct ChangeTrackSettings {};

/// One alternative for each method, in the order of kTrackingMethods.
using MethodSettings = std::
    variant<SphereSettings, ChangeTrackSettings, PlaneSettings, CylinderSettings, ConeSettings>;

inline constexpr std::array<std::string_view, std::variant_size_v<MethodSettings>> kTrackingMethods{
    "sphere", "change", "plane", "cylinder", "cone"};

/// One object to track, as given in {"objects":[…]} or by an experiment. Plain values here: JSON is
/// read by whoever has a file (server/experiments), the pipeline knows none.
struct ObjectSpec {
    std::string name;  ///< of the object, e.g. "bob"
    MethodSettings settings;
};

[[nodiscard]] inline std::string_view method_of(const ObjectSpec& spec) {
    return kTrackingMethods[spec.settings.index()];
}

/// Whether a method reports any number of things under one name instead of one object.
[[nodiscard]] inline bool finds_many(const ObjectSpec& spec) {
    return std::holds_alternative<ChangeTrackSettings>(spec.settings);
}

}  // namespace kinectlab
