#include "tests/bench/peer_stock_chain.hpp"

#include <limits>
#include <vector>

#include <pcl/ModelCoefficients.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/passthrough.h>
#include <pcl/octree/octree_pointcloud_changedetector.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/sac_segmentation.h>

namespace kinectlab::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
constexpr double kVoxel_m = 0.02;

Cloud::Ptr cloud_of(const RgbdCamera& camera, const RgbdFrame& frame) {
    auto cloud = std::make_shared<Cloud>(camera.depth.width, camera.depth.height);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int v = 0; v < camera.depth.height; ++v)
        for (int u = 0; u < camera.depth.width; ++u) {
            const auto depth = frame.depth[static_cast<std::size_t>(v * camera.depth.width + u)];
            auto& point = cloud->at(u, v);
            if (depth == 0) {
                point = {nan, nan, nan};
                continue;
            }
            const Eigen::Vector3f p =
                (camera.depth.ray(u, v) * (depth * camera.depth_unit_m)).cast<float>();
            point = {p.x(), p.y(), p.z()};
        }
    cloud->is_dense = false;
    return cloud;
}

}  // namespace

struct StockChain::State {
    Settings settings;
    pcl::PassThrough<pcl::PointXYZ> pass;
    pcl::octree::OctreePointCloudChangeDetector<pcl::PointXYZ> octree{kVoxel_m};
    Cloud::Ptr reference;

    Cloud::Ptr cut(const RgbdFrame& frame) {
        auto near = std::make_shared<Cloud>();
        pass.setInputCloud(cloud_of(settings.camera, frame));
        pass.setFilterFieldName("z");
        pass.setFilterLimits(0.1F, static_cast<float>(settings.cut_m));
        pass.filter(*near);
        return near;
    }

    void load_reference() {
        octree.deleteTree();
        octree.setInputCloud(reference);
        octree.addPointsFromInputCloud();
        octree.switchBuffers();
    }

    Cloud::Ptr moved(const Cloud::Ptr& cloud) {
        octree.setInputCloud(cloud);
        octree.addPointsFromInputCloud();
        std::vector<int> indices;
        octree.getPointIndicesFromNewVoxels(indices);
        return std::make_shared<Cloud>(*cloud, indices);
    }
};

StockChain::StockChain(const Settings& settings, const RgbdFrame& reference)
    : state_(std::make_unique<State>()) {
    state_->settings = settings;
    state_->reference = state_->cut(reference);
}

StockChain::~StockChain() = default;

std::optional<Eigen::Vector3d> StockChain::track(const RgbdFrame& frame) {
    state_->load_reference();
    const Cloud::Ptr moved = state_->moved(state_->cut(frame));
    if (moved->size() < 50) return std::nullopt;

    auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(moved);
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setKSearch(50);
    estimation.compute(*normals);

    pcl::SACSegmentationFromNormals<pcl::PointXYZ, pcl::Normal> segmentation;
    segmentation.setModelType(pcl::SACMODEL_NORMAL_SPHERE);
    segmentation.setMethodType(pcl::SAC_RANSAC);
    segmentation.setOptimizeCoefficients(true);
    segmentation.setNormalDistanceWeight(0.1);
    segmentation.setMaxIterations(1000);
    segmentation.setDistanceThreshold(0.01);
    const double r = state_->settings.radius_m;
    segmentation.setRadiusLimits(0.8 * r, 1.2 * r);
    segmentation.setInputCloud(moved);
    segmentation.setInputNormals(normals);
    pcl::PointIndices inliers;
    pcl::ModelCoefficients model;
    segmentation.segment(inliers, model);
    if (model.values.size() != 4) return std::nullopt;
    return Eigen::Vector3d(model.values[0], model.values[1], model.values[2]);
}

}  // namespace kinectlab::bench
