#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab::test {

struct Ball {
    Eigen::Vector3d centre_cam = Eigen::Vector3d::Zero();
    double radius = 0.05;
};

/// Balls before a wall, by plain geometry: a truth that shares no code with the project. The noise
/// is the disparity's alone, independent for each pixel.
class BallRoom {
public:
    double wall_m = 3.2;         ///< distance of a wall across the optical axis; 0 = none
    double sigma_steps = 0.577;  ///< Gaussian noise of the disparity
    double step = 2.85e-3;       ///< 1/m
    double missing_share = 0.0;  ///< of pixels without a reading
    bool string_above = false;   ///< 2 px wide, from each ball up to the picture's edge
    RgbdCamera camera;

    explicit BallRoom(unsigned seed = 1) : random_(seed) {}

    RgbdFrame frame(const std::vector<Ball>& balls) {
        RgbdFrame frame;
        const Pinhole& k = camera.depth;
        frame.index = index_;
        frame.t = static_cast<TimeNs>(index_++) * 33'333'333 + 1;
        frame.depth.resize(static_cast<std::size_t>(k.width * k.height));
        for (int v = 0; v < k.height; ++v)
            for (int u = 0; u < k.width; ++u)
                frame.depth[static_cast<std::size_t>(v * k.width + u)] =
                    noisy(distance(u, v, balls));
        return frame;
    }

    /// Z of what the middle of a pixel shows, 0 for nothing.
    [[nodiscard]] double distance(int u, int v, const std::vector<Ball>& balls) const {
        const Eigen::Vector3d d = camera.depth.ray(u, v);
        double z = wall_m;
        for (const auto& ball : balls) {
            const Eigen::Vector3d c = ball.centre_cam;
            // |z d - c| = r
            const double a = d.dot(d), b = -2.0 * d.dot(c),
                         e = c.dot(c) - ball.radius * ball.radius;
            const double under_root = b * b - 4.0 * a * e;
            if (under_root > 0.0) {
                const double hit = (-b - std::sqrt(under_root)) / (2.0 * a);
                if (z == 0.0 || hit < z) z = hit;
            }
            const Eigen::Vector2d middle = camera.depth.project(c);
            const bool on_string =
                string_above && std::abs(u - middle.x()) <= 1.0 && v < middle.y();
            if (on_string && (z == 0.0 || c.z() < z)) z = c.z();
        }
        return z;
    }

    std::uint16_t noisy(double z) {
        if (z <= 0.0) return 0;
        if (missing_share > 0.0 && uniform_(random_) < missing_share) return 0;
        const double w = 1.0 / z + step * sigma_steps * normal_(random_);
        return static_cast<std::uint16_t>(
            std::clamp(std::round(1.0 / (w * camera.depth_unit_m)), 1.0, 65535.0)
        );
    }

private:
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    std::uniform_real_distribution<double> uniform_;
    std::uint64_t index_ = 0;
};

}  // namespace kinectlab::test
