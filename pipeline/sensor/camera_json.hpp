#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"

namespace kinectlab {

/// What camera.json says beside a recording. Matrices are lists of rows, lengths metres.
///
///   fx, fy, cx, cy       depth camera, px                                      (required)
///   depth_scale          counts of a depth pixel for each metre                (required but for
///   PCD) width, height        of its pictures, px; without them those of the first picture color
///   colour camera where it is another one: fx, fy, cx, cy, [width, height],
///                        R_color_depth (3x3), t_color_depth_m (3): p_color = R p_depth + t
///   T_lab_cam            4x4: p_lab = T p_cam, lab z up, x along the main motion
///   depth_scale_u        relative standard uncertainty of depth_scale
///   clock_u              relative standard uncertainty of the clock's rate
///   noise                inverse_depth_step (1/m), sigma_steps
///   frame_rate_hz        nominal
///
/// "colour" is taken for "color". Other keys, numbers that are not finite or not possible and
/// matrices that do not rotate are errors that name the file and the key.
struct CameraFile {
    RgbdCamera camera;
    bool has_size = false;         ///< width and height were given
    bool has_colour = false;       ///< a colour camera was given; else it is the depth camera
    bool has_colour_size = false;  ///< and its size
    std::optional<Eigen::Isometry3d> T_lab_cam;
    std::optional<double> frame_rate_hz;
};

/// Whether depth comes in counts, whose unit depth_scale tells, or in metres, which need none.
enum class DepthUnit { in_counts, known };

[[nodiscard]] Result<CameraFile> read_camera_json(
    const std::filesystem::path& file, DepthUnit unit = DepthUnit::in_counts
);

/// The camera of a folder without camera.json: 640x480, 525, 525, 319.5, 239.5, 5000 (TUM, PCL).
[[nodiscard]] CameraFile default_camera();

/// Throws if the file cannot be written.
void write_camera_json(const std::filesystem::path& file, const CameraFile& camera);

}  // namespace kinectlab
