#include "tests/bench/peer_shot_grouping.hpp"

#include <pcl/features/board.h>
#include <pcl/features/normal_3d.h>
#include <pcl/features/shot.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <pcl/recognition/cg/hough_3d.h>

namespace kinectlab::bench {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Descriptors = pcl::PointCloud<pcl::SHOT352>;
using Frames = pcl::PointCloud<pcl::ReferenceFrame>;

constexpr double kTutorialRadius = 0.14;  // m, of the tutorial's carton
constexpr float kMostDistance = 0.25F;    // squared, of matching descriptors

struct Described {
    Cloud::Ptr cloud, keypoints = std::make_shared<Cloud>();
    Normals::Ptr normals = std::make_shared<Normals>();
    Descriptors::Ptr descriptors = std::make_shared<Descriptors>();
    Frames::Ptr frames = std::make_shared<Frames>();
};

Described describe(const Cloud::Ptr& cloud, double keypoint_spacing, double scale) {
    Described described;
    described.cloud = cloud;
    pcl::NormalEstimation<Point, pcl::Normal> normals;
    normals.setKSearch(10);
    normals.setInputCloud(cloud);
    normals.compute(*described.normals);
    pcl::UniformSampling<Point> sampling;
    sampling.setInputCloud(cloud);
    sampling.setRadiusSearch(keypoint_spacing * scale);
    sampling.filter(*described.keypoints);
    pcl::SHOTEstimation<Point, pcl::Normal, pcl::SHOT352> shot;
    shot.setRadiusSearch(0.02 * scale);
    shot.setInputCloud(described.keypoints);
    shot.setInputNormals(described.normals);
    shot.setSearchSurface(cloud);
    shot.compute(*described.descriptors);
    pcl::BOARDLocalReferenceFrameEstimation<Point, pcl::Normal, pcl::ReferenceFrame> board;
    board.setFindHoles(true);
    board.setRadiusSearch(0.015 * scale);
    board.setInputCloud(described.keypoints);
    board.setInputNormals(described.normals);
    board.setSearchSurface(cloud);
    board.compute(*described.frames);
    return described;
}

pcl::CorrespondencesPtr match(const Described& model, const Described& scene) {
    auto matches = std::make_shared<pcl::Correspondences>();
    pcl::KdTreeFLANN<pcl::SHOT352> tree;
    tree.setInputCloud(model.descriptors);
    std::vector<int> nearest(1);
    std::vector<float> distance(1);
    for (std::size_t i = 0; i < scene.descriptors->size(); ++i) {
        if (!std::isfinite((*scene.descriptors)[i].descriptor[0])) continue;
        const int found = tree.nearestKSearch((*scene.descriptors)[i], 1, nearest, distance);
        if (found == 1 && distance[0] < kMostDistance)
            matches->emplace_back(nearest[0], static_cast<int>(i), distance[0]);
    }
    return matches;
}

}  // namespace

std::optional<Eigen::Isometry3d> find_by_shot(
    const RgbdCamera& camera,
    const RgbdFrame& frame,
    const std::vector<Eigen::Vector3f>& model_points,
    double radius_m
) {
    const double scale = radius_m / kTutorialRadius;
    auto model_cloud = std::make_shared<Cloud>();
    for (const auto& p : model_points)
        model_cloud->push_back({p.x(), p.y(), p.z()});
    auto scene_cloud = std::make_shared<Cloud>();
    for (int v = 0; v < camera.depth.height; ++v)
        for (int u = 0; u < camera.depth.width; ++u) {
            const auto depth = frame.depth[static_cast<std::size_t>(v * camera.depth.width + u)];
            if (depth == 0) continue;
            const Eigen::Vector3f p =
                (camera.depth.ray(u, v) * (depth * camera.depth_unit_m)).cast<float>();
            scene_cloud->push_back({p.x(), p.y(), p.z()});
        }
    const Described model = describe(model_cloud, 0.01, scale);
    const Described scene = describe(scene_cloud, 0.03, scale);
    pcl::Hough3DGrouping<Point, Point, pcl::ReferenceFrame, pcl::ReferenceFrame> grouping;
    grouping.setHoughBinSize(0.01 * scale);
    grouping.setHoughThreshold(5.0);
    grouping.setUseInterpolation(true);
    grouping.setUseDistanceWeight(false);
    grouping.setInputCloud(model.keypoints);
    grouping.setInputRf(model.frames);
    grouping.setSceneCloud(scene.keypoints);
    grouping.setSceneRf(scene.frames);
    grouping.setModelSceneCorrespondences(match(model, scene));
    std::vector<Eigen::Matrix4f, Eigen::aligned_allocator<Eigen::Matrix4f>> poses;
    std::vector<pcl::Correspondences> clusters;
    grouping.recognize(poses, clusters);
    std::size_t most = 0;
    std::optional<Eigen::Isometry3d> best;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (clusters[i].size() <= most) continue;
        most = clusters[i].size();
        best = Eigen::Isometry3d(poses[i].cast<double>());
    }
    return best;
}

}  // namespace kinectlab::bench
