#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/features/keypoint2d.hpp"

namespace kinectlab::bench {

/// OpenCV's SIFT with its own values over the whole picture, one thread.
[[nodiscard]] std::vector<Keypoint2d> opencv_sift(const RgbdCamera& camera, const RgbdFrame& frame);

/// What anybody would put together from OpenCV: SIFT around the last place, as wide as the
/// project's tracker looks, or over the whole picture where there is none; brute-force matching
/// with Lowe's ratio, solvePnPRansac of the object's points (known in three dimensions from the
/// first frame) against where they are seen now. One thread.
class OpenCvSiftPose {
public:
    /// Learns the spots in a box of the colour picture; their depth is read where they are seen.
    OpenCvSiftPose(
        const RgbdCamera& camera, const RgbdFrame& first, int left, int top, int width, int height
    );
    ~OpenCvSiftPose();
    OpenCvSiftPose(const OpenCvSiftPose&) = delete;
    OpenCvSiftPose& operator=(const OpenCvSiftPose&) = delete;

    /// How the object moved since the first frame, depth camera's frame; nothing if not found.
    [[nodiscard]] std::optional<Eigen::Isometry3d> motion(const RgbdFrame& frame);

    /// The next frame is looked at as a whole.
    void forget_place();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::bench
