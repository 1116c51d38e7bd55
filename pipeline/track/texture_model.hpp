#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/frame.hpp"
#include "pipeline/features/spot_finder.hpp"
#include "pipeline/features/two_cameras.hpp"
#include "pipeline/track/rigid_fit.hpp"

namespace kinectlab {

/// A pose and what it rests on.
struct TexturePose {
    RigidFit fit;
    int matches = 0;         ///< that were offered to the fit
    double rms_steps = 0.0;  ///< of the inliers along the viewing rays, disparity steps
};

/// The spots of an object as it looked once, each with its place in three dimensions.
class TextureModel {
public:
    /// Keeps the spots that a finder found and whose traced points lie on the object: `on_object`
    /// has a byte for each depth pixel. Nothing where fewer than `fewest` remain. The object's
    /// frame: origin in the middle of its spots, axes those of the camera.
    [[nodiscard]] static std::optional<TextureModel> learn(
        const RgbdCamera& camera,
        const RgbdFrame& frame,
        std::unique_ptr<SpotFinder> found,
        std::span<const std::uint8_t> on_object,
        int fewest
    );

    /// Matches the spots found in a frame, traces them back to the surface, and fits the rigid
    /// transform; then looks again near where each spot must be, which finds those that were not
    /// clear without knowing the pose, and fits once more.
    [[nodiscard]] std::optional<TexturePose> pose_in(
        const RgbdFrame& frame, const SpotFinder& scene, int fewest_inliers
    );

    [[nodiscard]] const Eigen::Vector3d& origin_cam() const { return origin_cam_; }
    [[nodiscard]] double radius_m() const { return radius_m_; }
    [[nodiscard]] std::size_t size() const { return points_.size(); }

private:
    struct Point {
        Eigen::Vector3d p_obj;
        Eigen::Matrix3d covariance;
        float scale_m;
    };

    explicit TextureModel(const RgbdCamera& camera) : camera_(camera), cameras_(camera) {}
    void add_pair(const RgbdFrame& frame, const SpotFinder& scene, const Match& match);
    void match_near(const SpotFinder& scene, const Eigen::Isometry3d& T_cam_obj);
    [[nodiscard]] std::optional<RigidFit> fit(
        const RgbdFrame& frame,
        const SpotFinder& scene,
        std::span<const Match> matches,
        const RigidFitSettings& settings
    );

    RgbdCamera camera_;
    TwoCameras cameras_;
    std::unique_ptr<SpotFinder> spots_;
    std::vector<Point> points_;
    Eigen::Vector3d origin_cam_ = Eigen::Vector3d::Zero();
    double radius_m_ = 0.0;
    std::vector<Match> matches_;
    std::vector<PointPair> pairs_, first_pairs_;
    /// Of each spot in the scene that was traced, where it lies; nothing if on no surface.
    std::vector<std::optional<std::optional<TracedPoint>>> traced_;
    std::vector<std::uint32_t> by_row_, taken_;
};

}  // namespace kinectlab
