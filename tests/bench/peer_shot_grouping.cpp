#include "tests/bench/peer_shot_grouping.hpp"

#include <pcl/features/board.h>
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

// The tutorial's numbers are for points 2 mm apart without a Kinect's noise. Of descriptors of 3 to
// 8 cm, bins of 2 to 5 cm and squared distances of 0.25 to 1 none found the object; these are the
// middle.
constexpr double kSpacing = 0.01;     // m, of keypoints
constexpr double kDescriptor = 0.05;  // m
constexpr double kFrame = 0.05;       // m, of local reference frames
constexpr double kBin = 0.03;         // m, of the Hough space
constexpr double kLeastVotes = 5.0;
constexpr float kMostDistance = 1.0F;  // squared, of matching descriptors

struct Described {
    Cloud::Ptr cloud, keypoints = std::make_shared<Cloud>();
    Normals::Ptr normals = std::make_shared<Normals>();
    Descriptors::Ptr descriptors = std::make_shared<Descriptors>();
    Frames::Ptr frames = std::make_shared<Frames>();
};

Described describe(const OrientedPoints& oriented) {
    auto cloud = std::make_shared<Cloud>();
    Described described;
    described.cloud = cloud;
    for (std::size_t i = 0; i < oriented.points.size(); ++i) {
        const auto& p = oriented.points[i];
        const auto& n = oriented.normals[i];
        cloud->push_back({p.x(), p.y(), p.z()});
        described.normals->push_back({n.x(), n.y(), n.z()});
    }
    pcl::UniformSampling<Point> sampling;
    sampling.setInputCloud(cloud);
    sampling.setRadiusSearch(kSpacing);
    sampling.filter(*described.keypoints);
    pcl::SHOTEstimation<Point, pcl::Normal, pcl::SHOT352> shot;
    shot.setRadiusSearch(kDescriptor);
    shot.setInputCloud(described.keypoints);
    shot.setInputNormals(described.normals);
    shot.setSearchSurface(cloud);
    shot.compute(*described.descriptors);
    pcl::BOARDLocalReferenceFrameEstimation<Point, pcl::Normal, pcl::ReferenceFrame> board;
    board.setFindHoles(true);
    board.setRadiusSearch(kFrame);
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
    const OrientedPoints& model_points, const OrientedPoints& scene_points
) {
    const Described model = describe(model_points);
    const Described scene = describe(scene_points);
    pcl::Hough3DGrouping<Point, Point, pcl::ReferenceFrame, pcl::ReferenceFrame> grouping;
    grouping.setHoughBinSize(kBin);
    grouping.setHoughThreshold(kLeastVotes);
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
