#include "tests/bench/peer_shapes.hpp"

#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/sac_segmentation.h>

#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

int model_of(ShapeKind kind) {
    switch (kind) {
        case ShapeKind::sphere:
            return pcl::SACMODEL_NORMAL_SPHERE;
        case ShapeKind::cylinder:
            return pcl::SACMODEL_CYLINDER;
        case ShapeKind::cone:
            return pcl::SACMODEL_CONE;
        case ShapeKind::plane:
            break;
    }
    return pcl::SACMODEL_NORMAL_PLANE;
}

std::optional<Shape> shape_from(ShapeKind kind, const std::vector<float>& v) {
    const std::size_t needed = kind == ShapeKind::sphere || kind == ShapeKind::plane ? 4 : 7;
    if (v.size() != needed) return std::nullopt;
    if (kind == ShapeKind::plane) {
        const Eigen::Vector3d n(v[0], v[1], v[2]);
        return Shape{kind, -v[3] * n, n, 0.0};
    }
    Shape shape{kind, {v[0], v[1], v[2]}};
    if (kind == ShapeKind::sphere) {
        shape.size = v[3];
        return shape;
    }
    shape.axis = Eigen::Vector3d(v[3], v[4], v[5]).normalized();
    shape.size = std::abs(v[6]);
    return shape;
}

}  // namespace

StockShape stock_shape(
    const RgbdCamera& camera,
    const RgbdFrame& frame,
    std::span<const std::uint32_t> pixels,
    ShapeKind kind
) {
    auto cloud = std::make_shared<Cloud>();
    for (const auto pixel : pixels) {
        if (frame.depth[pixel] == 0) continue;
        const auto width = static_cast<std::uint32_t>(camera.depth.width);
        const Eigen::Vector3f p = (camera.depth.ray(pixel % width, pixel / width) *
                                   (frame.depth[pixel] * camera.depth_unit_m))
                                      .cast<float>();
        cloud->push_back({p.x(), p.y(), p.z()});
    }
    StockShape result;
    double start = thread_seconds();
    auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud);
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setKSearch(50);
    estimation.compute(*normals);
    result.normals_ms = 1e3 * (thread_seconds() - start);

    start = thread_seconds();
    pcl::SACSegmentationFromNormals<pcl::PointXYZ, pcl::Normal> segmentation;
    segmentation.setModelType(model_of(kind));
    segmentation.setMethodType(pcl::SAC_RANSAC);
    segmentation.setOptimizeCoefficients(true);
    segmentation.setNormalDistanceWeight(0.1);
    segmentation.setMaxIterations(1000);
    segmentation.setDistanceThreshold(0.01);
    segmentation.setRadiusLimits(0.01, 0.3);
    segmentation.setMinMaxOpeningAngle(0.087, 1.222);
    segmentation.setInputCloud(cloud);
    segmentation.setInputNormals(normals);
    pcl::PointIndices inliers;
    pcl::ModelCoefficients model;
    segmentation.segment(inliers, model);
    result.segmentation_ms = 1e3 * (thread_seconds() - start);
    result.shape = shape_from(kind, model.values);
    return result;
}

}  // namespace kinectlab::bench
