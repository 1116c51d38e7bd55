#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pipeline/core/mesh.hpp"

namespace kinectlab {

/// Method "sphere": a ball among what moved.
struct SphereSettings {
    std::optional<double> radius_m;  ///< known radius; free if absent
    double min_radius_m = 0.01;      ///< where it is free
    double max_radius_m = 0.30;
};

/// Method "change": whatever moved.
struct ChangeTrackSettings {};

/// Method "surface_patch": a rigid thing of any shape, known by a model of its surface.
struct SurfacePatchSettings {
    std::string model;                         ///< the file it came from, for messages
    double model_unit_m = 1.0;                 ///< metres for each unit of the file
    std::uint32_t seed = 1;                    ///< of what recognition draws by lot
    std::shared_ptr<const TriangleMesh> mesh;  ///< the file's content, in its unit
    std::vector<std::string> warnings;         ///< what a person should know of it
};

/// One alternative for each method, in the order of kTrackingMethods.
using MethodSettings = std::variant<SphereSettings, ChangeTrackSettings, SurfacePatchSettings>;

inline constexpr std::array<std::string_view, std::variant_size_v<MethodSettings>> kTrackingMethods{
    "sphere", "change", "surface_patch"};

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
