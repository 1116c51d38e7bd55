#include "pipeline/features/two_cameras.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr double kNearest_m = 0.3;  // nearer than any sensor of the family reads
constexpr double kFarthest_m = 12.0;
constexpr double kSeenWithin_px = 1.0;   // of the colour pixel: the same surface
constexpr int kHalfWindow = 3;           // of the plane around a traced point
constexpr double kMaxJump_sigmas = 6.0;  // beyond what a steep surface and noise explain: an edge
constexpr double kMaxSlope_steps = 2.0;  // of disparity a pixel, a steep surface
constexpr double kSharedNoise = 6.0;     // neighbours err together in a correlation window

struct RowGeometry {
    float x0, dx;          // ray of the first pixel, and from pixel to pixel
    float ax, ay, az;      // of R·(0, y, 1)
    float rx, ry, rz;      // first column of R
    float tx, ty, tz;      // m
    float fx, fy, cx, cy;  // of the colour camera, the centres raised by a half for rounding
    float unit;            // m a count
    int width, height;
};

KINECTLAB_HOT_LOOP void indices_of_row(
    const std::uint16_t* __restrict row,
    int count,
    const RowGeometry& g,
    std::int32_t* __restrict indices
) {
    for (int i = 0; i < count; ++i) {
        const float x = g.x0 + g.dx * static_cast<float>(i);
        const float z = g.unit * static_cast<float>(row[i]);
        const float px = (g.ax + g.rx * x) * z + g.tx;
        const float py = (g.ay + g.ry * x) * z + g.ty;
        const float pz = std::max(1e-3F, (g.az + g.rz * x) * z + g.tz);
        const float u = std::clamp(g.fx * px / pz + g.cx, -1.0F, 1e6F);
        const float v = std::clamp(g.fy * py / pz + g.cy, -1.0F, 1e6F);
        const auto column = static_cast<std::int32_t>(u);
        const auto line = static_cast<std::int32_t>(v);
        // Bitwise, so that the loop has no branch.
        const int inside = static_cast<int>(row[i] != 0) & static_cast<int>(u >= 0.0F) &
                           static_cast<int>(v >= 0.0F) & static_cast<int>(column < g.width) &
                           static_cast<int>(line < g.height);
        indices[i] = inside != 0 ? line * g.width + column : -1;
    }
}

}  // namespace

TwoCameras::TwoCameras(const RgbdCamera& camera)
    : camera_(camera),
      scale_(camera),
      origin_(camera.T_colour_depth.inverse().translation()),
      R_depth_(camera.T_colour_depth.linear().transpose()),
      inverse_far_(1.0 / kFarthest_m),
      inverse_near_(1.0 / kNearest_m) {}

void TwoCameras::colour_indices(
    const std::uint16_t* row, int u, int v, int count, std::int32_t* indices
) const {
    const Eigen::Matrix3f R = camera_.T_colour_depth.linear().cast<float>();
    const Eigen::Vector3f t = camera_.T_colour_depth.translation().cast<float>();
    const auto y = static_cast<float>((v - camera_.depth.cy) / camera_.depth.fy);
    const Eigen::Vector3f a = R * Eigen::Vector3f(0.0F, y, 1.0F);
    const RowGeometry g{
        static_cast<float>((u - camera_.depth.cx) / camera_.depth.fx),
        static_cast<float>(1.0 / camera_.depth.fx),
        a.x(),
        a.y(),
        a.z(),
        R(0, 0),
        R(1, 0),
        R(2, 0),
        t.x(),
        t.y(),
        t.z(),
        static_cast<float>(camera_.colour.fx),
        static_cast<float>(camera_.colour.fy),
        static_cast<float>(camera_.colour.cx + 0.5),
        static_cast<float>(camera_.colour.cy + 0.5),
        static_cast<float>(camera_.depth_unit_m),
        camera_.colour.width,
        camera_.colour.height};
    indices_of_row(row, count, g, indices);
}

std::optional<TracedPoint> TwoCameras::trace(
    std::span<const std::uint16_t> depth, double u, double v
) const {
    // Along the ray p = origin + ray·Z the pixel in the depth picture moves evenly with 1/Z.
    const Eigen::Vector3d ray = R_depth_ * camera_.colour.ray(u, v);
    const auto pixel_at = [&](double inverse_z) -> Eigen::Vector2d {
        return camera_.depth.project(origin_ + ray / inverse_z);
    };
    const Eigen::Vector2d near = pixel_at(inverse_near_), far = pixel_at(inverse_far_);
    const int steps = std::clamp(static_cast<int>(std::ceil((near - far).norm())), 1, 400);
    for (int i = 0; i <= steps; ++i) {
        const Eigen::Vector2d at = near + (far - near) * (static_cast<double>(i) / steps);
        const auto column = static_cast<int>(std::lround(at.x()));
        const auto line = static_cast<int>(std::lround(at.y()));
        if (column < 0 || line < 0 || column >= camera_.depth.width || line >= camera_.depth.height)
            continue;
        const auto reading = depth[static_cast<std::size_t>(line * camera_.depth.width + column)];
        if (reading == 0) continue;
        const Eigen::Vector3d p_cam =
            camera_.depth.ray(column, line) * (reading * camera_.depth_unit_m);
        if ((colour_pixel(p_cam) - Eigen::Vector2d(u, v)).cwiseAbs().maxCoeff() > kSeenWithin_px)
            continue;
        return meet_surface(depth, ray, p_cam);
    }
    return std::nullopt;
}

std::optional<TracedPoint> TwoCameras::meet_surface(
    std::span<const std::uint16_t> depth,
    const Eigen::Vector3d& ray,
    const Eigen::Vector3d& first_guess
) const {
    const Pinhole& k = camera_.depth;
    const Eigen::Vector2d middle = k.project(first_guess);
    const auto u0 = static_cast<int>(std::lround(middle.x()));
    const auto v0 = static_cast<int>(std::lround(middle.y()));
    if (u0 < kHalfWindow || v0 < kHalfWindow || u0 + kHalfWindow >= k.width ||
        v0 + kHalfWindow >= k.height)
        return std::nullopt;

    // The plane s = a du + b dv + c in disparity; any reading far from the middle one is an edge.
    const double s0 = scale_.steps_at(first_guess.z());
    const double sigma = scale_.sigma_at(s0);
    const double allowed = kMaxJump_sigmas * sigma + kMaxSlope_steps * kHalfWindow;
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sums = Eigen::Vector3d::Zero();
    int read = 0;
    for (int dv = -kHalfWindow; dv <= kHalfWindow; ++dv) {
        const auto* row = depth.data() + static_cast<std::ptrdiff_t>(v0 + dv) * k.width + u0;
        for (int du = -kHalfWindow; du <= kHalfWindow; ++du) {
            if (row[du] == 0) continue;
            const double s = scale_.steps(row[du]) - s0;
            if (std::abs(s) > allowed) return std::nullopt;
            const Eigen::Vector3d basis(du, dv, 1.0);
            moments += basis * basis.transpose();
            sums += basis * s;
            ++read;
        }
    }
    constexpr int kSide = 2 * kHalfWindow + 1;
    if (2 * read < kSide * kSide) return std::nullopt;
    const Eigen::Vector3d plane = moments.inverse() * sums;

    // The surface's disparity at a picture position is linear, and so is that position in the
    // ray's own inverse depth; two rounds settle far below a tenth of a pixel.
    Eigen::Vector3d p_cam = first_guess;
    for (int round = 0; round < 3; ++round) {
        const Eigen::Vector2d at = k.project(p_cam);
        const double s = s0 + plane.x() * (at.x() - u0) + plane.y() * (at.y() - v0) + plane.z();
        if (!(s > 0.0)) return std::nullopt;
        const double z = scale_.metres(s);
        p_cam = origin_ + ray * ((z - origin_.z()) / ray.z());
    }
    if (!p_cam.allFinite() || (k.project(p_cam) - Eigen::Vector2d(u0, v0)).norm() > kHalfWindow)
        return std::nullopt;
    TracedPoint traced;
    traced.p_cam = p_cam;
    traced.pixel = static_cast<std::uint32_t>(v0 * k.width + u0);
    const double sigma_s = sigma * std::sqrt(kSharedNoise / read);
    traced.sigma_z_m = p_cam.z() * sigma_s / scale_.steps_at(p_cam.z());
    return traced;
}

}  // namespace kinectlab
