#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/simulate/scene.hpp"

namespace kinectlab::simulate {

/// Pixels from (left, top) up to and without (right, bottom).
struct PixelRect {
    int left = 0, top = 0, right = 0, bottom = 0;
    [[nodiscard]] bool empty() const { return left >= right || top >= bottom; }
};

/// A body's picture lies inside; cut to the image. Empty if it is not all in front of the camera.
[[nodiscard]] PixelRect picture_of(
    const Pinhole& camera, const Shape& shape, const Eigen::Isometry3d& T_cam_body
);

/// Where the body stands in a camera's frame.
[[nodiscard]] Eigen::Isometry3d T_cam_body_of(const Eigen::Isometry3d& T_cam_lab, const Body& body);

/// One pixel that a string covers.
struct StringPixel {
    int u, v;
    float inverse_depth;
};

/// Noise-free depth, row-major, width x height.
struct ExactDepth {
    std::vector<float> inverse_depth;   ///< 1/Z in 1/m, in float exact to a micrometre; 0 = nothing
    std::vector<std::uint8_t> grazing;  ///< 0..255 = 0..90° between viewing ray and surface normal
    std::vector<PixelRect> bodies;      ///< where it may differ from the empty room
    std::vector<StringPixel> string;    ///< in front of the room, not drawn into inverse_depth
};

/// Casts a ray through every depth pixel. The room is cast once; later only what moves.
class DepthCaster {
public:
    DepthCaster(const Room& room, const Pinhole& camera, const Eigen::Isometry3d& T_lab_cam);

    /// The room with these bodies in it; valid until the next call.
    [[nodiscard]] const ExactDepth& cast(const MovingParts& moving);

    [[nodiscard]] const ExactDepth& empty_room() const { return room_; }

private:
    void clear(const PixelRect& rect);
    void draw_sphere(const PixelRect& rect, const Eigen::Vector3d& centre_cam, double radius_m);
    void draw_box(
        const PixelRect& rect, const Eigen::Vector3d& size_m, const Eigen::Isometry3d& T_cam_body
    );
    void draw(int u, int v, double depth, double facing);
    void find_string(const Eigen::Vector3d& from_cam, const Eigen::Vector3d& to_cam);

    Pinhole camera_;
    Eigen::Isometry3d T_cam_lab_;
    ExactDepth room_;
    ExactDepth now_;
};

}  // namespace kinectlab::simulate
