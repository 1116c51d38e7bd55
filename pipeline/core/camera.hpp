#pragma once

#include <Eigen/Geometry>

namespace kinectlab {

/// A pinhole camera without distortion; pixel centres at integer coordinates.
/// Camera frame: x right, y down, z forward, metres.
struct Pinhole {
    int width = 640;
    int height = 480;
    double fx = 525.0;  ///< px
    double fy = 525.0;  ///< px
    double cx = 319.5;  ///< px
    double cy = 239.5;  ///< px

    [[nodiscard]] Eigen::Vector3d ray(double u, double v) const {
        return {(u - cx) / fx, (v - cy) / fy, 1.0};
    }
    [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_cam) const {
        return {fx * p_cam.x() / p_cam.z() + cx, fy * p_cam.y() / p_cam.z() + cy};
    }
};

/// Triangulation measures disparity, and only there is the noise the same at every distance:
/// 1/Z changes by inverse_depth_step for each disparity step (Khoshelham & Elberink 2012).
struct DisparityNoise {
    double inverse_depth_step = 2.85e-3;  ///< 1/m for each disparity step
    double sigma_steps = 0.577350269;     ///< sqrt(0.5² + 1/12): noise and rounding
};

/// A depth camera and a colour camera on one bar; they do not look through the same hole.
struct RgbdCamera {
    Pinhole depth;
    Pinhole colour;
    Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();  ///< p_colour = T p_depth
    double depth_unit_m = 0.001;  ///< metres for each count of a depth pixel
    double depth_scale_u = 1e-3;  ///< relative standard uncertainty of the depth scale
    /// How well the lab frame's z is known to point up, about each horizontal axis.
    double tilt_u_rad = 0.02;
    double clock_u = 2e-5;  ///< relative standard uncertainty of the device clock's rate
    DisparityNoise noise;
};

}  // namespace kinectlab
