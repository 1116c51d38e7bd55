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
    /// Name of a ball: the plane that it touches, anywhere in the picture, whatever else is bigger.
    std::string under{};
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
struct ChangeTrackSettings {
    double memory_s = 2.0;  ///< so long a thing that is not seen keeps its name; 0 to 60
};

/// Method "surface_patch": a rigid thing of any shape, known by a model of its surface.
struct SurfacePatchSettings {
    std::string model;                         ///< the file it came from, for messages
    double model_unit_m = 1.0;                 ///< metres for each unit of the file
    std::uint32_t seed = 1;                    ///< of what recognition draws by lot
    std::shared_ptr<const TriangleMesh> mesh;  ///< the file's content, in its unit
    std::vector<std::string> warnings;         ///< what a person should know of it
};

/// A box in the colour picture, px; a click is a box of one pixel.
struct PictureBox {
    int left = 0;
    int top = 0;
    int width = 1;
    int height = 1;
};

/// Which colours pass: hue, saturation and value as every colour chooser shows them.
struct ColourBounds {
    double hue_min_deg = 0.0;  ///< 0 to 360; above hue_max_deg the range goes through red
    double hue_max_deg = 360.0;
    double saturation_min = 0.25;  ///< 0 to 1; greyer than that has no hue to speak of
    double saturation_max = 1.0;
    double value_min = 0.1;  ///< 0 to 1
    double value_max = 1.0;
};

/// Method "colour": whatever has a colour of its own. Give bounds or a box.
struct ColourSettings {
    std::optional<ColourBounds> bounds;
    std::optional<PictureBox> box;  ///< the colour is learned from what is there
    double learn_at_s = 0.0;        ///< in the first frame this long after the first one
};

/// How spots of a texture are described.
enum class TextureSpots {
    sift,    ///< bears change of size and view
    binary,  ///< costs less, bears less change
};

/// Method "texture": whatever has a print, a pattern or spots on it.
struct TextureSettings {
    std::optional<PictureBox> box;  ///< the object's first look; else what moved
    double learn_at_s = 0.0;        ///< not before this long after the first frame
    TextureSpots spots = TextureSpots::sift;
    int fewest_spots = 8;  ///< that must agree on a pose
};

/// Method "sift3d": whatever has a texture on a shape, by spots of the surface in space.
struct Sift3dTrackSettings {
    std::optional<PictureBox> box;
    double learn_at_s = 0.0;
    double scale_m = 0.004;  ///< of the smallest spots; also the voxel's side
    int fewest_spots = 6;    ///< that must agree on a pose
};

/// One alternative for each method, in the order of kTrackingMethods.
using MethodSettings = std::variant<
    SphereSettings,
    ChangeTrackSettings,
    SurfacePatchSettings,
    ColourSettings,
    TextureSettings,
    Sift3dTrackSettings,
    PlaneSettings,
    CylinderSettings,
    ConeSettings>;

inline constexpr std::array<std::string_view, std::variant_size_v<MethodSettings>> kTrackingMethods{
    "sphere",
    "change",
    "surface_patch",
    "colour",
    "texture",
    "sift3d",
    "plane",
    "cylinder",
    "cone"};

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

/// Whether a method cannot do without the colour picture.
[[nodiscard]] inline bool needs_colour(const ObjectSpec& spec) {
    return std::holds_alternative<ColourSettings>(spec.settings) ||
           std::holds_alternative<TextureSettings>(spec.settings) ||
           std::holds_alternative<Sift3dTrackSettings>(spec.settings);
}

}  // namespace kinectlab
