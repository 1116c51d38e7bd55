#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/track/correlated_noise.hpp"
#include "pipeline/track/model_proof.hpp"
#include "pipeline/track/model_view.hpp"
#include "pipeline/track/shape_pixels.hpp"

namespace kinectlab {

/// How far a start may be off: what is not seen in the picture stays within it.
struct ModelFitStart {
    double sigma_m = 0.03;
    double sigma_rad = 0.3;
    double gate_m = 0.04;  ///< readings further off the surface are not its own at first
};

/// A model laid upon a depth picture.
struct ModelFit {
    Eigen::Isometry3d T_cam_obj;  ///< of the model's centre
    Matrix6d covariance;   ///< position of the centre (m²), rotation vector (rad²), camera frame
    TrackQuality quality;  ///< inlier_share is of the readings that could show the object
    double seen_share = 0.0;          ///< of its surface on this side; holes say nothing
    double seen_through_share = 0.0;  ///< readings from behind it: it cannot be there
    std::size_t pixels = 0;           ///< that it covers in the picture
    ModelProof proof;
    double outline_share = 0.0;  ///< of its outline: found where it should be; 0 without one
};

/// Lays a model upon a depth picture, starting near. What the object would look like is drawn; each
/// reading is compared with the model's tangent plane there, along its own ray and in disparity,
/// where the noise is the same everywhere; the outline is looked for across itself. Gauss-Newton on
/// Tukey's weights, closing from a wide gate to the noise; drawn anew in each round.
/// A plane n·p = d that moves by (δt, δω about the centre c) changes the inverse depth at a ray r
/// by
///   -n·(δt + δω x (q - c)) / ((n·r) Z²),  q = Z r the point it shows.
/// The covariance reckons with what neighbouring pixels err together, on the surface (measured,
/// CorrelatedNoise) and along the outline. Not thread-safe; no allocation once warm.
class ModelFitter {
public:
    explicit ModelFitter(const RgbdCamera& camera, const ModelViewer::Settings& view = {});

    /// Nothing if too little of the object is in the picture. Whether the result is the object is
    /// for the caller to judge from the shares.
    [[nodiscard]] std::optional<ModelFit> fit(
        std::span<const std::uint16_t> depth,
        const ObjectModel& model,
        const Eigen::Isometry3d& T_start,
        const ModelFitStart& start,
        int rounds = 2
    );

private:
    struct Equations;
    void add_surface(
        std::span<const std::uint16_t> depth,
        const ModelView& view,
        const Eigen::Isometry3d& T,
        double gate_m,
        Equations& sums
    );
    void add_outline(
        std::span<const std::uint16_t> depth,
        const ModelView& view,
        const Eigen::Isometry3d& T,
        int reach,
        Equations& sums
    ) const;

    RgbdCamera camera_;
    DisparityScale scale_;
    ModelViewer viewer_;
    CorrelatedNoise noise_;
    ShapePixels readings_;  // of the last add_surface, residuals in standard deviations
};

}  // namespace kinectlab
