#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"

namespace kinectlab {

/// What an object shows from one side, as few points as tell a wrong pose from a likely one. Model
/// frame, about its centre, m.
struct SketchView {
    struct Point {
        Eigen::Vector3f p_obj;
        Eigen::Vector3f n_obj;  ///< unit, towards the camera
    };
    std::vector<Point> surface;  ///< in random order: the first ones are spread over it as well
    std::vector<Eigen::Vector3f> outside;  ///< beside its outline: what is seen there is not it
    Eigen::Matrix3f R_cam_obj = Eigen::Matrix3f::Identity();  ///< seen from along the optical axis
};

/// Checks thousands of poses against a depth picture, and moves a rough one nearer. The surface's
/// points are looked for at their own pixels, as in projective ICP (Rusinkiewicz & Levoy 2001).
/// Not thread-safe.
class PoseCheck {
public:
    PoseCheck(const RgbdCamera& camera, double radius_m);

    /// The picture that is looked at from here on, in counts; 0 = no reading.
    void set(std::span<const std::uint16_t> depth);

    /// 1 where every point of the surface is read and nothing beside it goes on at its depth; less
    /// for each reading that says no. A reading before a point says nothing, nor does a hole,
    /// of up to a fifth of the points.
    [[nodiscard]] float score(const Eigen::Isometry3f& T_cam_obj, const SketchView& view) const;

    /// A few Gauss-Newton steps of the distances from the readings to the surface's planes.
    [[nodiscard]] Eigen::Isometry3f settle(Eigen::Isometry3f T_cam_obj, const SketchView& view)
        const;

private:
    [[nodiscard]] float reading_at(const Eigen::Vector3f& p_cam) const;

    float fx_, fy_, cx_, cy_;
    int width_, height_;
    float unit_m_, gate_m_;
    std::vector<float> z_;  // m
};

}  // namespace kinectlab
