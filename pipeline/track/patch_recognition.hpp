#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>

#include "pipeline/track/model_fit.hpp"
#include "pipeline/track/moved_poses.hpp"
#include "pipeline/track/patch_table.hpp"

namespace kinectlab {

/// How sure a fit must be to be the object.
struct Acceptance {
    double least_seen = 0.5;      ///< of the visible surface: half of it may be hidden
    double least_inliers = 0.88;  ///< of the readings on it or behind it
    double least_outline = 0.6;   ///< of the outline, where the model has one
    double most_rms_sigmas = 3.0;
    double most_misfit = 0.15;   ///< of the readings at its surface
    double most_goes_on = 0.12;  ///< of its outline: where it does it is a part of something larger
};

[[nodiscard]] bool is_accepted(
    const ModelFit& fit,
    const ObjectModel& model,
    const RgbdCamera& camera,
    const Acceptance& limits
);

/// Finds an object anywhere in a picture. What moved is looked at first, from all sides
/// (moved_poses). Otherwise each of the picture's patches proposes, for the model's
/// patches that the table gives it, the poses that lay one keypoint, its normal and its direction
/// of least bending upon the other's (two, the direction has no sign); poses are checked on a
/// growing number of the view's points against the readings, moved nearer, checked again, the best
/// are laid upon the picture by ModelFitter, and the best of those is taken if it is accepted.
/// The same seed finds the same. Not thread-safe.
class PatchRecogniser {
public:
    PatchRecogniser(
        const RgbdCamera& camera, std::shared_ptr<const ObjectModel> model, std::uint32_t seed = 1
    );

    /// In what moved, segments of row-major pixels: some milliseconds for each of the biggest.
    [[nodiscard]] std::optional<ModelFit> find_moved(
        std::span<const std::uint16_t> depth, std::span<const std::span<const std::uint32_t>> moved
    );

    /// Anywhere: some tenths of a second. Where it lies in something that moved, it must be all of
    /// it, or have its whole outline.
    [[nodiscard]] std::optional<ModelFit> find(
        std::span<const std::uint16_t> depth,
        std::span<const std::span<const std::uint32_t>> moved = {}
    );

    /// Patches of the model in its table; an object without any, such as a ball, is never found.
    [[nodiscard]] std::size_t model_patches() const { return table_.size(); }

private:
    struct Proposal {
        Eigen::Isometry3f T_cam_obj;
        float score;
        std::uint32_t view;
    };

    struct Sketch {
        Eigen::Isometry3d T_cam_obj;
        float score;
        std::uint32_t view;
        double merit;
    };

    struct Found {
        ModelFit fit;
        double merit;
        std::uint32_t view;
    };

    void propose(const SurfacePatch& patch);
    void consider(const SurfacePatch& patch, const ModelPatch& match);
    void consider(const ViewPose& pose);
    [[nodiscard]] std::size_t moved_about(
        const Found& found, std::span<const std::span<const std::uint32_t>> moved
    );
    [[nodiscard]] std::vector<Proposal> distinct_best(std::size_t most) const;
    [[nodiscard]] std::vector<Sketch> best_sketches(
        std::span<const std::uint16_t> depth, std::size_t most, std::size_t moved_pixels
    );
    [[nodiscard]] std::optional<Found> best_fit(
        std::span<const std::uint16_t> depth, std::size_t most, std::size_t moved_pixels
    );
    [[nodiscard]] bool is_blurred(double z_m) const;
    [[nodiscard]] double merit(const ModelFit& fit, float score, std::size_t moved_pixels) const;

    RgbdCamera camera_;
    std::shared_ptr<const ObjectModel> model_;
    PatchSettings settings_;
    std::mt19937 random_;
    PatchTable table_;
    PoseCheck check_;
    ModelFitter sketch_, fitter_;
    std::vector<Proposal> proposals_;
    std::vector<std::uint8_t> moved_;  // 1 + number of the segment, a value a pixel
};

}  // namespace kinectlab
