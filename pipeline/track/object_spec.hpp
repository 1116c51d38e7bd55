#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinectlab {

/// Method "sphere": a ball among what moved.
struct SphereSettings {
    std::optional<double> radius_m;  ///< known radius; free if absent
    double min_radius_m = 0.01;      ///< where it is free
    double max_radius_m = 0.30;
};

/// Method "change": whatever moved.
struct ChangeTrackSettings {
    double memory_s = 2.0;  ///< so long a thing that is not seen keeps its name; 0 to 60
};

/// One alternative for each method, in the order of kTrackingMethods.
using MethodSettings = std::variant<SphereSettings, ChangeTrackSettings>;

inline constexpr std::array<std::string_view, std::variant_size_v<MethodSettings>> kTrackingMethods{
    "sphere", "change"};

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
