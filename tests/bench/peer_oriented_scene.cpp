#include "tests/bench/peer_oriented_scene.hpp"

#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>

namespace kinectlab::bench {

OrientedPoints oriented_scene(
    const RgbdCamera& camera, const RgbdFrame& frame, double farthest_m, double lowest_m
) {
    auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    for (int v = 0; v < camera.depth.height; v += 2)
        for (int u = 0; u < camera.depth.width; u += 2) {
            const auto depth = frame.depth[static_cast<std::size_t>(v * camera.depth.width + u)];
            if (depth == 0) continue;
            const Eigen::Vector3f p =
                (camera.depth.ray(u, v) * (depth * camera.depth_unit_m)).cast<float>();
            if (p.z() > farthest_m || p.y() > lowest_m) continue;
            cloud->push_back({p.x(), p.y(), p.z()});
        }
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setRadiusSearch(0.02);
    estimation.setInputCloud(cloud);
    pcl::PointCloud<pcl::Normal> normals;
    estimation.compute(normals);

    OrientedPoints scene;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
        const Eigen::Vector3f normal = normals[i].getNormalVector3fMap();
        if (!normal.allFinite()) continue;
        scene.points.emplace_back((*cloud)[i].getVector3fMap());
        scene.normals.push_back(normal);
    }
    return scene;
}

}  // namespace kinectlab::bench
