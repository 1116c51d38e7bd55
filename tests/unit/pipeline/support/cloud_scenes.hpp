#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/cloud.hpp"
#include "pipeline/sensor/pcd_file.hpp"

namespace kinectlab::test {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A picture small enough to try every pair of points.
inline Pinhole small_camera(int width = 64, int height = 48) {
    Pinhole camera;
    camera.width = width;
    camera.height = height;
    camera.fx = camera.fy = 120.0;
    camera.cx = (width - 1) / 2.0;
    camera.cy = (height - 1) / 2.0;
    return camera;
}

/// Calls z(u, v, ray) for every pixel; 0 or less is no reading.
template <class Depth>
Cloud render(const Pinhole& camera, Depth z) {
    Cloud cloud = blank_cloud(camera.width, camera.height);
    for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d ray = camera.ray(u, v);
            const double depth = z(u, v, ray);
            if (!(depth > 0.0)) continue;
            const auto i = static_cast<std::size_t>(v * camera.width + u);
            cloud.x[i] = static_cast<float>(ray.x() * depth);
            cloud.y[i] = static_cast<float>(ray.y() * depth);
            cloud.z[i] = static_cast<float>(depth);
        }
    }
    return cloud;
}

/// Depth of the plane n·p = d along a ray.
inline double plane_depth(const Eigen::Vector3d& n, double d, const Eigen::Vector3d& ray) {
    return d / n.dot(ray);
}

/// A slanted wall with a board before it, noise, holes and a few readings in mid-air.
inline Cloud messy_scene(const Pinhole& camera, unsigned seed, double sigma_m = 0.003) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, sigma_m);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    return render(camera, [&](int u, int v, const Eigen::Vector3d& ray) {
        const double chance = uniform(random);
        if (chance < 0.05) return 0.0;
        if (chance < 0.055) return 0.7 + uniform(random);
        const bool board = u > camera.width / 3 && u < camera.width / 2 && v > camera.height / 4;
        const double z =
            board ? 0.9 : plane_depth(Eigen::Vector3d(0.4, 0.1, -1).normalized(), -1.2, ray);
        return z + noise(random);
    });
}

inline Cloud as_list(const Cloud& cloud) {
    Cloud list = cloud;
    list.width = static_cast<int>(cloud.size());
    list.height = 1;
    return list;
}

inline Cloud list_of(const std::vector<Eigen::Vector3f>& points) {
    Cloud cloud = blank_cloud(static_cast<int>(points.size()), 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        cloud.x[i] = points[i].x();
        cloud.y[i] = points[i].y();
        cloud.z[i] = points[i].z();
    }
    return cloud;
}

inline Eigen::Vector3f point(const Cloud& cloud, std::size_t i) {
    return {cloud.x[i], cloud.y[i], cloud.z[i]};
}

inline std::vector<Eigen::Vector3f> random_points(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> side(-0.5F, 0.5F);
    std::vector<Eigen::Vector3f> points(n);
    for (auto& p : points)
        p = {side(random), side(random), 1.5F + side(random)};
    return points;
}

/// A file of the shared data; empty where the folder is missing.
inline std::filesystem::path shared_data(const std::string& name) {
    const char* given = std::getenv("KINECTLAB_SHARED_DATA");
    const std::filesystem::path folder =
        given != nullptr ? given : std::string(KINECTLAB_SOURCE_DIR) + "/../shared/data";
    const auto path = folder / name;
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

inline Result<Cloud> read_pcd(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(stream), {});
    auto pcd = parse_pcd(bytes, path.filename().string());
    if (!pcd) return tl::unexpected(pcd.error());
    return Cloud{pcd->width, pcd->height, pcd->x, pcd->y, pcd->z, pcd->rgb};
}

}  // namespace kinectlab::test
