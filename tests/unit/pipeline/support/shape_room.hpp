#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab::test {

/// Solids by plain geometry, each face told by the step along a ray at which it is entered: a truth
/// that shares no code with the project.
struct Solid {
    enum class Kind { wall, ball, can, cone, box } kind = Kind::wall;
    /// A point of the wall; the ball's or box's middle; the middle of the can's base; the apex.
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< wall: normal; can, cone: unit
    double radius = 0.0;                              ///< ball, can
    double angle = 0.0;                               ///< cone, between axis and surface
    double from = 0.0, to = 0.0;                      ///< can, cone: along the axis
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< box
};

inline Solid wall(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    return {Solid::Kind::wall, point, normal.normalized()};
}
inline Solid ball(const Eigen::Vector3d& centre, double radius) {
    return {Solid::Kind::ball, centre, Eigen::Vector3d::UnitY(), radius};
}
inline Solid can(
    const Eigen::Vector3d& base, const Eigen::Vector3d& axis, double radius, double height
) {
    return {Solid::Kind::can, base, axis.normalized(), radius, 0.0, 0.0, height};
}
inline Solid cone(
    const Eigen::Vector3d& apex, const Eigen::Vector3d& axis, double angle, double from, double to
) {
    return {Solid::Kind::cone, apex, axis.normalized(), 0.0, angle, from, to};
}
inline Solid box(
    const Eigen::Vector3d& middle, const Eigen::Matrix3d& turn, const Eigen::Vector3d& half
) {
    return {Solid::Kind::box, middle, Eigen::Vector3d::UnitY(), 0, 0, 0, 0, turn, half};
}

/// Z at which a ray (x, y, 1) enters a solid, and by which face: 0 its round or only one, else lids
/// and the faces of a box.
struct Entry {
    double z = 0.0;
    int face = 0;
};

inline std::optional<Entry> enter(const Solid& solid, const Eigen::Vector3d& d) {
    std::optional<Entry> nearest;
    const auto offer = [&](double z, int face) {
        if (z > 0.05 && (!nearest || z < nearest->z)) nearest = Entry{z, face};
    };
    const auto roots = [](double a, double b, double c) {  // of a z² + b z + c
        const double under = b * b - 4.0 * a * c;
        std::array<double, 2> z{-1.0, -1.0};
        if (under > 0.0)
            z = {(-b - std::sqrt(under)) / (2.0 * a), (-b + std::sqrt(under)) / (2.0 * a)};
        return z;
    };
    const Eigen::Vector3d& c = solid.place;
    const Eigen::Vector3d& n = solid.axis;
    const auto lids = [&](const std::function<double(double)>& radius_at) {
        int face = 1;
        for (const double h : {solid.from, solid.to}) {
            const Eigen::Vector3d middle = c + h * n;
            const double z = n.dot(middle) / n.dot(d);
            if ((z * d - middle).norm() <= radius_at(h)) offer(z, face);
            ++face;
        }
    };
    switch (solid.kind) {
        case Solid::Kind::wall:
            offer(n.dot(c) / n.dot(d), 0);
            break;
        case Solid::Kind::ball:
            for (const double z :
                 roots(d.dot(d), -2 * d.dot(c), c.dot(c) - solid.radius * solid.radius))
                offer(z, 0);
            break;
        case Solid::Kind::can: {
            const Eigen::Vector3d da = d - n * n.dot(d), ca = c - n * n.dot(c);
            for (const double z :
                 roots(da.dot(da), -2 * da.dot(ca), ca.dot(ca) - solid.radius * solid.radius)) {
                const double h = n.dot(z * d - c);
                if (h >= solid.from && h <= solid.to) offer(z, 0);
            }
            lids([&](double) { return solid.radius; });
            break;
        }
        case Solid::Kind::cone: {
            const double k = std::pow(std::cos(solid.angle), 2);
            const double dn = d.dot(n), cn = c.dot(n);
            for (const double z : roots(
                     dn * dn - k * d.dot(d), 2 * (k * d.dot(c) - dn * cn), cn * cn - k * c.dot(c)
                 )) {
                const double h = n.dot(z * d - c);
                if (h >= solid.from && h <= solid.to) offer(z, 0);
            }
            lids([&](double h) { return h * std::tan(solid.angle); });
            break;
        }
        case Solid::Kind::box: {
            const Eigen::Vector3d o = -solid.turn.transpose() * c, e = solid.turn.transpose() * d;
            for (int axis = 0; axis < 3; ++axis)
                for (const double side : {-1.0, 1.0}) {
                    const double z = (side * solid.half[axis] - o[axis]) / e[axis];
                    const Eigen::Vector3d hit = (o + z * e).cwiseAbs();
                    const int b = (axis + 1) % 3, f = (axis + 2) % 3;
                    if (hit[b] <= solid.half[b] && hit[f] <= solid.half[f])
                        offer(z, 2 * axis + (side > 0 ? 1 : 0));
                }
            break;
        }
    }
    return nearest;
}

/// A depth picture of solids. The noise is the disparity's alone, independent for each pixel.
class ShapeRoom {
public:
    RgbdCamera camera;
    double sigma_steps = 0.577350269;
    std::vector<Solid> solids;
    /// After a picture: which solid each pixel shows, -1 for none, and by which face.
    std::vector<int> solid_at, face_at;

    explicit ShapeRoom(unsigned seed = 1) : random_(seed) {
        camera.depth_unit_m = 0.0001;  // fine counts: the noise is what it is said to be
    }

    RgbdFrame frame() {
        RgbdFrame frame;
        const Pinhole& k = camera.depth;
        frame.index = index_;
        frame.t = static_cast<TimeNs>(index_++) * 33'333'333 + 1;
        const auto pixels = static_cast<std::size_t>(k.width * k.height);
        frame.depth.assign(pixels, 0);
        if (solid_at.size() != pixels || clean_.size() != pixels) render();
        for (std::size_t i = 0; i < pixels; ++i) {
            if (clean_[i] == 0.0) continue;
            const double w =
                1.0 / clean_[i] + camera.noise.inverse_depth_step * sigma_steps * normal_(random_);
            const double counts = std::round(1.0 / (w * camera.depth_unit_m));
            frame.depth[i] =
                static_cast<std::uint16_t>(counts >= 1.0 && counts <= 65535.0 ? counts : 0.0);
        }
        return frame;
    }

    /// Asks for a new picture after solids were changed.
    void changed() { clean_.clear(); }

    /// Pixels that show a solid, or one face of it.
    [[nodiscard]] std::vector<std::uint32_t> pixels_of(int solid, int face = -1) const {
        std::vector<std::uint32_t> pixels;
        for (std::size_t i = 0; i < solid_at.size(); ++i)
            if (solid_at[i] == solid && (face < 0 || face_at[i] == face))
                pixels.push_back(static_cast<std::uint32_t>(i));
        return pixels;
    }

private:
    void render() {
        const Pinhole& k = camera.depth;
        const auto pixels = static_cast<std::size_t>(k.width * k.height);
        clean_.assign(pixels, 0.0);
        solid_at.assign(pixels, -1);
        face_at.assign(pixels, 0);
        for (int v = 0; v < k.height; ++v)
            for (int u = 0; u < k.width; ++u) {
                const auto i = static_cast<std::size_t>(v * k.width + u);
                const Eigen::Vector3d d = k.ray(u, v);
                for (std::size_t s = 0; s < solids.size(); ++s) {
                    const auto entry = enter(solids[s], d);
                    if (!entry || (clean_[i] != 0.0 && entry->z >= clean_[i])) continue;
                    clean_[i] = entry->z;
                    solid_at[i] = static_cast<int>(s);
                    face_at[i] = entry->face;
                }
            }
    }

    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    std::uint64_t index_ = 0;
    std::vector<double> clean_;
};

}  // namespace kinectlab::test
