#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/core/mesh.hpp"

namespace kinectlab::test {

/// A thing in the room: a mesh and where it is.
struct Thing {
    TriangleMesh mesh;
    Eigen::Isometry3d T_cam_obj = Eigen::Isometry3d::Identity();
};

/// Meshes before a wall, found by meeting every ray with every triangle (Möller & Trumbore 1997): a
/// truth that shares no code with the project. Gaussian noise of the disparity and its rounding to
/// whole steps, after Khoshelham & Elberink 2012; independent for each pixel if not told otherwise.
class MeshRoom {
public:
    double wall_m = 2.5;   ///< distance of a wall across the optical axis; 0 = none
    double floor_m = 0.0;  ///< y of a level floor below the camera; 0 = none
    double sigma_steps = 0.5;
    double step = 2.85e-3;  ///< 1/m
    double shared = 0.0;    ///< of the noise's variance common to 5x5 neighbours, as in a Kinect
    double missing_share = 0.0;
    bool rounded = true;
    RgbdCamera camera;

    explicit MeshRoom(unsigned seed = 1) : random_(seed) {}

    RgbdFrame frame(const std::vector<Thing>& things) {
        const Pinhole& k = camera.depth;
        std::vector<double> z(static_cast<std::size_t>(k.width * k.height), wall_m);
        if (floor_m > 0.0) lay_floor(z);
        for (const auto& thing : things)
            put(thing, z);
        RgbdFrame frame;
        frame.index = index_;
        frame.t = static_cast<TimeNs>(index_++) * 33'333'333 + 1;
        frame.depth.resize(z.size());
        if (shared > 0.0) draw_shared();
        for (std::size_t i = 0; i < z.size(); ++i)
            frame.depth[i] = noisy(z[i], shared > 0.0 ? common_[i] : 0.0);
        return frame;
    }

private:
    void lay_floor(std::vector<double>& z) const {
        const Pinhole& k = camera.depth;
        for (int v = 0; v < k.height; ++v) {
            const double down = (v - k.cy) / k.fy;
            if (down <= 0.0) continue;
            for (int u = 0; u < k.width; ++u) {
                double& now = z[static_cast<std::size_t>(v * k.width + u)];
                const double at = floor_m / down;
                if (now == 0.0 || at < now) now = at;
            }
        }
    }

    void put(const Thing& thing, std::vector<double>& z) const {
        for (const auto& corners : thing.mesh.triangles) {
            std::array<Eigen::Vector3d, 3> p;
            for (std::size_t i = 0; i < 3; ++i)
                p[i] = thing.T_cam_obj * thing.mesh.vertices[corners[i]].cast<double>();
            meet(p, z);
        }
    }

    void meet(const std::array<Eigen::Vector3d, 3>& p, std::vector<double>& z) const {
        const Pinhole& k = camera.depth;
        double low_u = 1e9, high_u = -1e9, low_v = 1e9, high_v = -1e9;
        for (const auto& corner : p) {
            if (corner.z() < 0.05) return;
            const Eigen::Vector2d at = k.project(corner);
            low_u = std::min(low_u, at.x()), high_u = std::max(high_u, at.x());
            low_v = std::min(low_v, at.y()), high_v = std::max(high_v, at.y());
        }
        const Eigen::Vector3d e1 = p[1] - p[0], e2 = p[2] - p[0];
        const int from_u = std::max(0, static_cast<int>(low_u) - 1);
        const int from_v = std::max(0, static_cast<int>(low_v) - 1);
        const int to_u = std::min(k.width - 1, static_cast<int>(high_u) + 1);
        const int to_v = std::min(k.height - 1, static_cast<int>(high_v) + 1);
        for (int v = from_v; v <= to_v; ++v) {
            for (int u = from_u; u <= to_u; ++u) {
                const Eigen::Vector3d ray = k.ray(u, v);
                const Eigen::Vector3d h = ray.cross(e2);
                const double det = e1.dot(h);
                if (std::abs(det) < 1e-15) continue;
                const Eigen::Vector3d s = -p[0];
                const double a = s.dot(h) / det;
                const Eigen::Vector3d q = s.cross(e1);
                const double b = ray.dot(q) / det;
                const double t = e2.dot(q) / det;
                if (a < 0.0 || b < 0.0 || a + b > 1.0 || t <= 0.0) continue;
                double& now = z[static_cast<std::size_t>(v * k.width + u)];
                if (now == 0.0 || t < now) now = t;
            }
        }
    }

    /// Sums over 5x5 of white noise, of variance 1.
    void draw_shared() {
        const int width = camera.depth.width, height = camera.depth.height;
        const auto size = static_cast<std::size_t>(width * height);
        std::vector<double> white(size), rows(size);
        for (auto& value : white)
            value = normal_(random_);
        common_.assign(size, 0.0);
        for (std::size_t i = 2; i + 2 < size; ++i)
            rows[i] = white[i - 2] + white[i - 1] + white[i] + white[i + 1] + white[i + 2];
        const auto w = static_cast<std::size_t>(width);
        for (std::size_t i = 2 * w; i + 2 * w < size; ++i)
            common_[i] =
                0.2 * (rows[i - 2 * w] + rows[i - w] + rows[i] + rows[i + w] + rows[i + 2 * w]);
    }

    std::uint16_t noisy(double z, double common) {
        if (z <= 0.0) return 0;
        if (missing_share > 0.0 &&
            std::uniform_real_distribution<>(0.0, 1.0)(random_) < missing_share)
            return 0;
        double steps = 1.0 / (step * z);
        if (sigma_steps > 0.0)
            steps += sigma_steps *
                     (std::sqrt(shared) * common + std::sqrt(1.0 - shared) * normal_(random_));
        if (rounded) steps = std::round(steps);
        const double counts = std::round(1.0 / (step * steps) / camera.depth_unit_m);
        return counts > 0.0 && counts < 65535.0 ? static_cast<std::uint16_t>(counts)
                                                : std::uint16_t{0};
    }

    std::mt19937 random_;
    std::normal_distribution<> normal_{0.0, 1.0};
    std::vector<double> common_;
    std::uint64_t index_ = 0;
};

/// A box about the origin, its sides in metres.
inline TriangleMesh box_mesh(double x, double y, double z) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.push_back(
            Eigen::Vector3d((i & 1 ? x : -x) / 2, (i & 2 ? y : -y) / 2, (i & 4 ? z : -z) / 2)
                .cast<float>()
        );
    for (const auto& f : std::array<std::array<std::uint32_t, 4>, 6>{
             {{0, 2, 3, 1},
              {4, 5, 7, 6},
              {0, 1, 5, 4},
              {2, 6, 7, 3},
              {0, 4, 6, 2},
              {1, 3, 7, 5}}}) {
        mesh.triangles.push_back({f[0], f[1], f[2]});
        mesh.triangles.push_back({f[0], f[2], f[3]});
    }
    return mesh;
}

/// What a potter's wheel makes of a profile of (radius, height) pairs, about the y axis, m.
inline TriangleMesh turned_mesh(const std::vector<Eigen::Vector2d>& profile, int around = 32) {
    TriangleMesh mesh;
    const auto n = static_cast<std::uint32_t>(around);
    for (const auto& ring : profile)
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * M_PI * i / around;
            mesh.vertices.push_back(
                Eigen::Vector3d(ring.x() * std::cos(angle), ring.y(), ring.x() * std::sin(angle))
                    .cast<float>()
            );
        }
    for (std::uint32_t ring = 0; ring + 1 < profile.size(); ++ring)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = ring * n + i, b = ring * n + (i + 1) % n;
            mesh.triangles.push_back({a, b, a + n});
            mesh.triangles.push_back({b, b + n, a + n});
        }
    return mesh;
}

/// Two meshes as one.
inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, const Eigen::Vector3d& b_at) {
    const auto first = static_cast<std::uint32_t>(a.vertices.size());
    for (const auto& vertex : b.vertices)
        a.vertices.push_back(vertex + b_at.cast<float>());
    for (const auto& corners : b.triangles)
        a.triangles.push_back({corners[0] + first, corners[1] + first, corners[2] + first});
    return a;
}

}  // namespace kinectlab::test
