#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape.hpp"

namespace kinectlab {

/// A ball as it was found in a frame.
struct SeenBall {
    Eigen::Vector3d centre_cam = Eigen::Vector3d::Zero();
    double radius_m = 0.0;
};

/// How far a ball's surface is from a plane on the camera's side of which it lies, m; below 0 where
/// it reaches through.
[[nodiscard]] inline double gap_between(const SeenBall& ball, const Shape& plane) {
    return plane.axis.dot(ball.centre_cam - plane.point) - ball.radius_m;
}

/// What the places of a ball and of a plane that touch may be wrong by together, m.
[[nodiscard]] inline double most_gap(const SeenBall& ball) {
    return 0.004 + 0.2 * ball.radius_m;
}

[[nodiscard]] inline bool touches(const SeenBall& ball, const Shape& plane) {
    return std::abs(gap_between(ball, plane)) <= most_gap(ball);
}

/// Looks for the plane that a ball touches in the readings around it, so that walls and floors, be
/// they ever so big, are out of the question. Keeps its buffers. Not thread-safe.
class TouchedPlane {
public:
    explicit TouchedPlane(const RgbdCamera& camera);

    /// Roughly, to be refined. Nothing where no plane around the ball touches it.
    [[nodiscard]] std::optional<Shape> find(const DisparityImage& image, const SeenBall& ball);

    /// The pixels of the last search that lie in the plane it found.
    [[nodiscard]] const std::vector<std::uint32_t>& pixels() const { return in_plane_; }

private:
    void gather(const DisparityImage& image, const SeenBall& ball);
    [[nodiscard]] std::size_t support(const Shape& plane) const;

    Pinhole camera_;
    DisparityScale scale_;
    std::vector<std::uint32_t> around_, in_plane_;
    std::vector<Eigen::Vector3d> points_;  ///< of `around_`, m
};

}  // namespace kinectlab
