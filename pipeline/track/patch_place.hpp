#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/track/outline_error.hpp"

namespace kinectlab {

/// Where a patch of visible surface is, from pixels that belong to it more or less, and how sure
/// that is. Holds one patch from frame to frame; the covariance is the sum of
///   - the readings' noise, neighbours' shared part reckoned with,
///   - the outline (OutlineError),
///   - the common mode: what the centroid moves by if all votes count for more or for less,
///   - how far a new patch is expected to wander, until its outline was compared for a while,
///   - what is hidden, if less is seen than usual.
class PatchPlace {
public:
    /// Of the vote on an outline: what wandering light and a print leave open.
    static constexpr double kCommonMode = 0.15;

    explicit PatchPlace(const RgbdCamera& camera);

    struct Place {
        int points = 0;
        double area_m2 = 0.0;  ///< seen, across the line of sight
        Eigen::Vector3d centroid_cam = Eigen::Vector3d::Zero();
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        /// Principal axes as columns, longest first, a right-handed turn; signs are arbitrary.
        Eigen::Matrix3d axes_cam = Eigen::Matrix3d::Identity();
        Eigen::Matrix3d turn_covariance = Eigen::Matrix3d::Zero();  ///< of the axes, rad²
        bool axes_known = false;  ///< the three are clearly of different length
    };

    /// `votes` as SurfaceVote counts them; a pixel belongs to the patch by half where it has
    /// `half_vote`, by a whole at one and a half of that. `pixels` have a reading.
    [[nodiscard]] Place measure(
        const RgbdFrame& frame,
        std::span<const std::uint32_t> pixels,
        std::span<const std::uint8_t> votes,
        double half_vote
    );

    /// For a patch that was just learned: light that changes may move its place so far.
    void expect_wander(const Eigen::Vector3d& by) { wander_ = by; }

    /// The patch was out of sight: nothing to compare the next outline with.
    void lose();
    /// Another patch.
    void forget();

    /// Area and centroid alone, to choose among patches.
    struct Glance {
        double area_m2 = 0.0;
        Eigen::Vector3d centroid_cam = Eigen::Vector3d::Zero();
    };
    [[nodiscard]] Glance glance(const RgbdFrame& frame, std::span<const std::uint32_t> pixels)
        const;

private:
    [[nodiscard]] Eigen::Vector3d point(const RgbdFrame& frame, std::uint32_t pixel) const;
    void keep_axes(Place& place, const Eigen::Matrix3d& spread) const;

    RgbdCamera camera_;
    OutlineError outline_;
    OutlineError::Memory memory_;
    Eigen::Vector3d wander_ = Eigen::Vector3d::Zero();
    std::vector<OutlineError::Pixel> now_, before_;
    double usual_area_m2_ = 0.0;
};

/// The axes with those signs that turn least from other axes.
[[nodiscard]] Eigen::Matrix3d nearest_signs(
    const Eigen::Matrix3d& axes_cam, const Eigen::Matrix3d& before_cam
);

}  // namespace kinectlab
