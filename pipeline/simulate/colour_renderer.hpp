#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/simulate/depth_caster.hpp"
#include "pipeline/simulate/random.hpp"
#include "pipeline/simulate/scene.hpp"

namespace kinectlab::simulate {

/// The colour camera's picture. The room is rendered once, at some cost; a frame then draws the
/// bodies, their shadows on the table and the strings into it, all with smooth edges, and adds the
/// sensor's noise.
class ColourRenderer {
public:
    ColourRenderer(const Room& room, const Pinhole& camera, const Eigen::Isometry3d& T_lab_colour);

    /// `rgb` gets width x height x 3 bytes, sRGB.
    void render(
        const MovingParts& moving,
        const FrameRandom& random,
        bool noisy,
        std::vector<std::uint8_t>& rgb
    );

private:
    void restore(const PixelRect& rect);
    void draw_shadow(const Eigen::Vector3d& centre_lab, double radius_m);
    void draw_string(const Wire& wire);
    void draw_bodies(const std::vector<Body>& bodies);
    void draw_sphere(const Body& body, const PixelRect& rect);
    void draw_box(const Body& body, const PixelRect& rect);
    void blend(int u, int v, const Eigen::Vector3f& linear, float share);

    Pinhole camera_;
    Eigen::Isometry3d T_lab_colour_;
    bool has_table_;
    std::vector<std::uint8_t> room_;
    std::vector<std::uint8_t> now_;
    std::vector<PixelRect> drawn_;  ///< what differs from the room
};

}  // namespace kinectlab::simulate
