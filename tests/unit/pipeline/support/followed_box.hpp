#pragma once

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/track/tracker.hpp"
#include "tests/unit/pipeline/support/textured_scene.hpp"

namespace kinectlab::test {

/// A printed box that moves and turns from frame to frame, and a tracker that saw it first at step
/// 0.
inline PrintedBox moving_box(int step) {
    PrintedBox box;
    box.half_m = {0.08, 0.11, 0.04};
    box.T_cam_box.translation() << 0.015 * step, 0.02, 1.0 + 0.01 * step;
    const Eigen::Vector3d axis = Eigen::Vector3d(0.1, 1.0, 0.2).normalized();
    box.T_cam_box.linear() = Eigen::AngleAxisd(0.1 + 0.02 * step, axis).toRotationMatrix();
    return box;
}

/// A place in the colour picture well inside of the box's front.
inline PictureBox front_of(const PrintedBox& box, const RgbdCamera& camera) {
    const Eigen::Vector2d at =
        camera.colour.project(camera.T_colour_depth * box.T_cam_box.translation());
    const double px = camera.colour.fx / box.T_cam_box.translation().z();
    const int width = static_cast<int>(1.7 * box.half_m.x() * px);
    const int height = static_cast<int>(1.7 * box.half_m.y() * px);
    return {
        static_cast<int>(at.x()) - width / 2, static_cast<int>(at.y()) - height / 2, width, height};
}

inline std::unique_ptr<Tracker> tracker_of(const RgbdCamera& camera, MethodSettings settings) {
    const std::vector<ObjectSpec> objects{{"box", std::move(settings)}};
    auto trackers = make_trackers(camera, objects);
    EXPECT_TRUE(trackers) << (trackers ? "" : to_text(trackers.error()));
    return std::move(trackers->front());
}

inline TrackSample sample_of(
    Tracker& tracker, const RgbdFrame& frame, std::span<const MovedPixels> moved = {}
) {
    std::vector<TrackSample> samples;
    tracker.track(frame, moved, samples);
    EXPECT_EQ(samples.size(), 1U);
    return samples.front();
}

struct PoseError {
    Eigen::Vector3d place_m, turn_rad;
};

/// Against the truth: whatever point the tracker reports, it moves and turns as the box does.
inline PoseError error_of(
    const TrackSample& first, const PrintedBox& then, const TrackSample& now, const PrintedBox& box
) {
    const Eigen::Isometry3d moved = box.T_cam_box * then.T_cam_box.inverse();
    const Eigen::AngleAxisd turn(
        now.q_cam_obj * Eigen::Quaterniond(moved.linear() * first.q_cam_obj.matrix()).inverse()
    );
    return {now.p_cam - moved * first.p_cam, turn.angle() * turn.axis()};
}

}  // namespace kinectlab::test
