#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/features/surface_patch.hpp"
#include "pipeline/track/object_model.hpp"
#include "pipeline/track/pose_check.hpp"

namespace kinectlab {

/// A surface patch of a model and the view that showed it, from the model's centre.
struct ModelPatch {
    SurfacePatch patch;  ///< its points and directions are in the model's frame
    std::uint32_t view = 0;
};

/// What an object's patches look like from all sides: Chen & Bhanu's hash table. The key is the
/// surface type with the mean and the spread of the shape index; what is looked up lies in the same
/// cell or next to it. Immutable once made.
class PatchTable {
public:
    /// Draws the model from 42 directions, as a camera at the distance at which it is as large as a
    /// thing on a table, and finds its patches. `random` orders each view's points.
    PatchTable(
        const RgbdCamera& camera,
        const ObjectModel& model,
        const PatchSettings& settings,
        std::mt19937& random
    );

    /// The model's patches that look most like it, best first; valid until the next call.
    [[nodiscard]] std::vector<const ModelPatch*> look_up(
        const SurfacePatch& patch, std::size_t most, double most_distance
    ) const;

    /// What the view showed, for checks of poses.
    [[nodiscard]] const SketchView& view(std::uint32_t index) const { return views_[index]; }
    [[nodiscard]] std::uint32_t views() const { return static_cast<std::uint32_t>(views_.size()); }
    [[nodiscard]] std::size_t size() const { return patches_.size(); }

private:
    static constexpr int kCells = 12;  // of the mean and of the spread

    [[nodiscard]] static int cell_of(float value) {
        return std::clamp(static_cast<int>(value * kCells), 0, kCells - 1);
    }
    [[nodiscard]] static std::size_t key(SurfaceType type, int mean, int spread) {
        return (static_cast<std::size_t>(type) * kCells + static_cast<std::size_t>(mean)) * kCells +
               static_cast<std::size_t>(spread);
    }

    std::vector<ModelPatch> patches_;
    std::vector<SketchView> views_;
    std::vector<std::vector<std::uint32_t>> cells_;
};

/// Directions from which a model is drawn: the corners of an icosahedron and the middles of its
/// edges, unit vectors.
[[nodiscard]] std::vector<Eigen::Vector3d> view_directions();

}  // namespace kinectlab
