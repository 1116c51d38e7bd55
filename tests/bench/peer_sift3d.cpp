#include "tests/bench/peer_sift3d.hpp"

#include <pcl/keypoints/sift_keypoint.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace kinectlab::bench {

std::vector<Eigen::Vector3f> pcl_sift3d_keypoints(
    std::span<const ValuedPoint> points, const Sift3dSettings& settings
) {
    auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
    cloud->reserve(points.size());
    for (const auto& point : points) {
        pcl::PointXYZI one;
        one.x = point.p_cam.x();
        one.y = point.p_cam.y();
        one.z = point.p_cam.z();
        one.intensity = point.value;
        cloud->push_back(one);
    }
    pcl::SIFTKeypoint<pcl::PointXYZI, pcl::PointWithScale> detector;
    detector.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZI>>());
    detector.setScales(settings.smallest_scale_m, settings.octaves, settings.scales_per_octave);
    detector.setMinimumContrast(settings.least_contrast);
    detector.setInputCloud(cloud);
    pcl::PointCloud<pcl::PointWithScale> found;
    detector.compute(found);
    std::vector<Eigen::Vector3f> keypoints;
    for (const auto& point : found)
        keypoints.emplace_back(point.x, point.y, point.z);
    return keypoints;
}

}  // namespace kinectlab::bench
