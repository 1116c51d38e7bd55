#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab::test {

/// A box with a print on its faces; pose in the depth camera's frame.
struct PrintedBox {
    Eigen::Vector3d half_m{0.06, 0.10, 0.03};
    Eigen::Isometry3d T_cam_box = Eigen::Isometry3d::Identity();
    std::uint32_t print = 1;  ///< which picture is printed on it; 0 = none, plain colour
    std::array<double, 3> colour{200.0, 160.0, 90.0};
};

/// Printed boxes before a wall, seen by two cameras that do not look through the same hole. Plain
/// geometry: a truth that shares no code with the project.
class TexturedScene {
public:
    double wall_m = 2.5;
    bool printed_wall = false;
    double sigma_steps = 0.577;           ///< of the disparity
    double shared = 0.7;                  ///< of its variance common to neighbours, as in a Kinect
    double edge_px = 0.4;                 ///< a depth pixel looks this far aside
    double colour_noise = 2.0;            ///< of 255
    std::array<double, 3> gain{1, 1, 1};  ///< of the colour camera: brightness, white balance
    RgbdCamera camera;

    /// `smaller` divides the pictures' 640x480 pixels, for tests that do not need them all.
    explicit TexturedScene(unsigned seed = 1, int smaller = 1) : random_(seed) {
        camera.depth.fx = camera.depth.fy = 580.0;
        camera.colour.fx = camera.colour.fy = 525.0;
        camera.colour.cx = 322.0;
        camera.colour.cy = 243.0;
        camera.T_colour_depth.linear() =
            Eigen::AngleAxisd(0.01, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()).toRotationMatrix();
        camera.T_colour_depth.translation() = Eigen::Vector3d(-0.025, 0.001, 0.0005);
        for (Pinhole* k : {&camera.depth, &camera.colour}) {
            k->width /= smaller, k->height /= smaller;
            k->fx /= smaller, k->fy /= smaller;
            k->cx = (k->cx + 0.5) / smaller - 0.5, k->cy = (k->cy + 0.5) / smaller - 0.5;
        }
    }

    RgbdFrame frame(const std::vector<PrintedBox>& boxes) {
        RgbdFrame frame;
        frame.index = index_;
        frame.t = static_cast<TimeNs>(index_++) * 33'333'333 + 1;
        frame.t_colour = frame.t;
        draw_depth(boxes, frame.depth);
        draw_colour(boxes, frame.rgb);
        return frame;
    }

private:
    struct Hit {
        double along = 0.0;  // of the ray
        const PrintedBox* box = nullptr;
        int face = 0;
        std::array<double, 3> p{};  // in the box's frame
    };

    /// The boxes as one camera sees them: rays turned into each box's frame by plain numbers.
    class View {
    public:
        View(
            const std::vector<PrintedBox>& boxes,
            const Eigen::Vector3d& origin,
            const Eigen::Matrix3d& R,
            double wall_m
        )
            : origin_z_(origin.z()), wall_m_(wall_m), rz_{R(2, 0), R(2, 1), R(2, 2)} {
            for (const auto& box : boxes) {
                const Eigen::Matrix3d R_box = box.T_cam_box.linear().transpose();
                const Eigen::Vector3d o = R_box * (origin - box.T_cam_box.translation());
                const Eigen::Matrix3d turn = R_box * R;
                Seen seen;
                seen.box = &box;
                for (int a = 0; a < 3; ++a) {
                    const auto i = static_cast<std::size_t>(a);
                    seen.half[i] = box.half_m[a];
                    seen.o[i] = o[a];
                    for (int b = 0; b < 3; ++b)
                        seen.turn[i][static_cast<std::size_t>(b)] = turn(a, b);
                }
                seen_.push_back(seen);
            }
        }

        /// Along the camera's ray (x, y, 1).
        [[nodiscard]] Hit cast(double x, double y) const {
            Hit hit;
            hit.along = (wall_m_ - origin_z_) / (rz_[0] * x + rz_[1] * y + rz_[2]);
            for (const auto& s : seen_) {
                std::array<double, 3> d{};
                double in = 0.0, out = 1e9;
                int face = 0;
                for (std::size_t a = 0; a < 3; ++a) {
                    d[a] = s.turn[a][0] * x + s.turn[a][1] * y + s.turn[a][2];
                    double t0 = (-s.half[a] - s.o[a]) / d[a], t1 = (s.half[a] - s.o[a]) / d[a];
                    if (t0 > t1) std::swap(t0, t1);
                    if (t0 > in) in = t0, face = 2 * static_cast<int>(a) + (d[a] > 0.0 ? 0 : 1);
                    out = std::min(out, t1);
                }
                if (in >= out || in >= hit.along || in <= 0.0) continue;
                hit.along = in;
                hit.box = s.box;
                hit.face = face;
                for (std::size_t a = 0; a < 3; ++a)
                    hit.p[a] = s.o[a] + in * d[a];
            }
            return hit;
        }

    private:
        struct Seen {
            const PrintedBox* box = nullptr;
            std::array<double, 3> half{}, o{};
            std::array<std::array<double, 3>, 3> turn{};
        };
        double origin_z_, wall_m_;
        std::array<double, 3> rz_;
        std::vector<Seen> seen_;
    };

    static std::uint32_t mix(std::uint32_t h) {
        h ^= h >> 16, h *= 0x7feb352dU, h ^= h >> 15, h *= 0x846ca68bU;
        return h ^ (h >> 16);
    }

    /// Patches of random brightness at three sizes: something like lettering and pictures.
    static double print_at(double a, double b, std::uint32_t print) {
        double value = 0.0;
        for (const double cell : {0.004, 0.011, 0.031}) {
            const auto i = static_cast<std::int32_t>(std::floor(a / cell + 0.37));
            const auto j = static_cast<std::int32_t>(std::floor(b / cell + 0.71));
            const auto h =
                mix(static_cast<std::uint32_t>(i) * 73856093U ^
                    mix(static_cast<std::uint32_t>(j) * 19349663U + print * 83492791U));
            value += (h & 3U) == 0U ? -0.5 : (h & 3U) == 1U ? 0.3 : 0.1;
        }
        return std::clamp(0.75 + 0.6 * value, 0.08, 1.1);
    }

    std::array<double, 3> colour_of(const Hit& hit, double wall_x, double wall_y) const {
        if (hit.box == nullptr) {
            const double shade = printed_wall ? 0.6 * print_at(wall_x / 4, wall_y / 4, 77) : 0.6;
            return {215 * shade, 220 * shade, 225 * shade};
        }
        const auto& box = *hit.box;
        const auto axis = static_cast<std::size_t>(hit.face / 2);
        const double a = hit.p[(axis + 1) % 3], b = hit.p[(axis + 2) % 3];
        const auto face = static_cast<std::uint32_t>(hit.face);
        const double shade = (box.print == 0 ? 0.8 : print_at(a, b, box.print * 6 + face)) *
                             (1.0 - 0.08 * static_cast<double>(axis));
        return {box.colour[0] * shade, box.colour[1] * shade, box.colour[2] * shade};
    }

    /// White noise of variance 1, and means of 5x5 of it scaled to the same variance.
    std::vector<double> shared_noise(int width, int height) {
        const auto size = static_cast<std::size_t>(width * height);
        std::vector<double> white(size), rows(size), wide(size);
        for (auto& value : white)
            value = normal_(random_);
        const auto at = [&](int u, int v) {
            return static_cast<std::size_t>(
                std::clamp(v, 0, height - 1) * width + std::clamp(u, 0, width - 1)
            );
        };
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u)
                for (int off = -2; off <= 2; ++off)
                    rows[at(u, v)] += white[at(u + off, v)];
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u)
                for (int off = -2; off <= 2; ++off)
                    wide[at(u, v)] += 0.2 * rows[at(u, v + off)];
        return wide;
    }

    void draw_depth(const std::vector<PrintedBox>& boxes, std::vector<std::uint16_t>& depth) {
        const Pinhole& k = camera.depth;
        const std::vector<double> wide = shared_noise(k.width, k.height);
        const View view(boxes, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), wall_m);
        depth.resize(wide.size());
        const double step = camera.noise.inverse_depth_step * sigma_steps;
        for (int v = 0; v < k.height; ++v)
            for (int u = 0; u < k.width; ++u) {
                const Hit hit = view.cast(
                    (u + edge_px * normal_(random_) - k.cx) / k.fx,
                    (v + edge_px * normal_(random_) - k.cy) / k.fy
                );
                const auto i = static_cast<std::size_t>(v * k.width + u);
                const double noise =
                    std::sqrt(shared) * wide[i] + std::sqrt(1.0 - shared) * normal_(random_);
                const double w = 1.0 / hit.along + step * noise;
                depth[i] = static_cast<std::uint16_t>(
                    std::clamp(std::round(1.0 / (w * camera.depth_unit_m)), 1.0, 65535.0)
                );
            }
    }

    void draw_colour(const std::vector<PrintedBox>& boxes, std::vector<std::uint8_t>& rgb) {
        const Pinhole& k = camera.colour;
        const Eigen::Isometry3d T_depth_colour = camera.T_colour_depth.inverse();
        const View view(boxes, T_depth_colour.translation(), T_depth_colour.linear(), wall_m);
        rgb.resize(static_cast<std::size_t>(3 * k.width * k.height));
        for (int v = 0; v < k.height; ++v)
            for (int u = 0; u < k.width; ++u) {
                std::array<double, 3> sum{};
                for (const double dv : {-0.25, 0.25})
                    for (const double du : {-0.25, 0.25}) {
                        const double x = (u + du - k.cx) / k.fx, y = (v + dv - k.cy) / k.fy;
                        const Hit hit = view.cast(x, y);
                        const auto colour = colour_of(hit, hit.along * x, hit.along * y);
                        for (std::size_t c = 0; c < 3; ++c)
                            sum[c] += 0.25 * colour[c];
                    }
                auto* pixel = rgb.data() + static_cast<std::size_t>(3 * (v * k.width + u));
                for (std::size_t c = 0; c < 3; ++c)
                    pixel[c] = static_cast<std::uint8_t>(std::clamp(
                        sum[c] * gain[c] + colour_noise * normal_(random_) + 0.5, 0.0, 255.0
                    ));
            }
    }

    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    std::uint64_t index_ = 0;
};

}  // namespace kinectlab::test
