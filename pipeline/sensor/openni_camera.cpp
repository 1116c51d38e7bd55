#include "pipeline/sensor/openni_camera.hpp"

#include <cmath>

#include "pipeline/drivers/simulated_rig/protocol.hpp"

namespace kinectlab {
namespace {

constexpr double kPrimeSenseFocal = 575.816;  // px at a width of 640, from a field of view of 58.1°
constexpr double kPrimeSenseBaseline = 0.025;  // m from the depth camera to the colour camera

Pinhole from_field_of_view(int width, int height, double fov_rad) {
    const bool known = fov_rad > 0.1 && fov_rad < 3.0;
    const double f =
        known ? 0.5 * width / std::tan(0.5 * fov_rad) : kPrimeSenseFocal * width / 640.0;
    return {width, height, f, f, 0.5 * (width - 1), 0.5 * (height - 1)};
}

Eigen::Isometry3d isometry(const double (&rows)[16]) {
    Eigen::Isometry3d T;
    T.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows);
    return T;
}

void take_geometry(const simulated_rig::CameraGeometry& g, SourceInfo& info) {
    auto& camera = info.camera;
    camera.depth = {
        camera.depth.width, camera.depth.height, g.depth_fx, g.depth_fy, g.depth_cx, g.depth_cy};
    camera.colour = {
        camera.colour.width,
        camera.colour.height,
        g.colour_fx,
        g.colour_fy,
        g.colour_cx,
        g.colour_cy};
    camera.T_colour_depth = isometry(g.T_colour_depth);
    camera.noise = {g.inverse_depth_step, g.sigma_steps};
    camera.depth_scale_u = g.depth_scale_u;
    camera.tilt_u_rad = g.tilt_u_rad;
    camera.clock_u = g.clock_u;
    info.T_lab_cam = isometry(g.T_lab_cam);
}

}  // namespace

SourceInfo describe(const std::string& uri, OpenniDevice& device) {
    const auto& modes = device.modes();
    SourceInfo info;
    info.name = uri.empty() ? modes.name : uri;
    info.frame_rate_hz = modes.fps;
    info.frame_count = modes.recorded_frames;
    auto& camera = info.camera;
    camera.depth_unit_m = modes.depth_unit_m;
    camera.depth = from_field_of_view(modes.width, modes.height, modes.horizontal_fov_rad);
    camera.colour = camera.depth;
    if (modes.colour_width > 0 && modes.colour_horizontal_fov_rad > 0.0) {
        camera.colour = from_field_of_view(
            modes.colour_width, modes.colour_height, modes.colour_horizontal_fov_rad
        );
    } else if (modes.colour_width > 0) {
        camera.colour =
            from_field_of_view(modes.colour_width, modes.colour_height, modes.horizontal_fov_rad);
    }
    if (!modes.recorded_frames) camera.T_colour_depth.translation().x() = -kPrimeSenseBaseline;

    simulated_rig::CameraGeometry geometry{};
    const bool simulated = device.get_property(
        simulated_rig::kGeometry, std::as_writable_bytes(std::span(&geometry, 1))
    );
    if (simulated) take_geometry(geometry, info);
    return info;
}

}  // namespace kinectlab
