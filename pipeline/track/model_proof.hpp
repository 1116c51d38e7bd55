#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "pipeline/core/disparity.hpp"
#include "pipeline/track/model_view.hpp"

namespace kinectlab {

/// What speaks against a model that was laid upon a picture. A fit draws what lies near to the
/// model's surface and leaves the rest out, so that it cannot tell a thing from one of about its
/// shape or from a part of a larger one.
struct ModelProof {
    /// Of the readings at its surface, those off it by more than noise and a mesh's own
    /// faults explain; what hides it counts for nothing.
    double misfit_share = 0.0;
    /// Of its outline, where the face that ends there goes on in the picture. Only faces seen at
    /// more than 20° are asked, and of what is hidden nothing is known.
    double goes_on_share = 0.0;
};

/// `view` is the model's at T_cam_obj, of its centre; `depth` in counts, 0 = no reading.
[[nodiscard]] ModelProof prove(
    std::span<const std::uint16_t> depth,
    const Pinhole& lens,
    const DisparityScale& scale,
    const ModelView& view,
    const Eigen::Isometry3d& T_cam_obj
);

}  // namespace kinectlab
