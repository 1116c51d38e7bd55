#include "tests/bench/peer_preprocess.hpp"

#include <pcl/common/point_tests.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/octree/octree_pointcloud_changedetector.h>
#include <pcl/point_types.h>
#include <pcl/surface/mls.h>

#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

using Point = pcl::PointXYZ;
using Vectors = std::vector<Eigen::Vector3f>;
const Eigen::Vector3f kNone = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());

}  // namespace

struct StockCloud::State {
    pcl::PointCloud<Point>::Ptr cloud;
};

StockCloud::StockCloud(const Cloud& cloud) : state_(std::make_unique<State>()) {
    auto& made = state_->cloud = std::make_shared<pcl::PointCloud<Point>>(
        static_cast<std::uint32_t>(cloud.width), static_cast<std::uint32_t>(cloud.height)
    );
    for (std::size_t i = 0; i < cloud.size(); ++i)
        (*made)[i] = Point(cloud.x[i], cloud.y[i], cloud.z[i]);
    made->is_dense = false;
}

StockCloud::~StockCloud() = default;

Timed<Mask> stock_pass_through(const StockCloud& cloud, double limit_m) {
    Timed<Mask> result{Mask(cloud.state().cloud->size(), 0)};
    pcl::PassThrough<Point> pass;
    pcl::PointCloud<Point> near;
    const double start = thread_seconds();
    pass.setInputCloud(cloud.state().cloud);
    pass.setFilterFieldName("z");
    pass.setFilterLimits(0.1F, static_cast<float>(limit_m));
    pass.filter(near);  // the points themselves, as ours writes the picture without the wall
    result.ms = 1e3 * (thread_seconds() - start);
    pcl::Indices kept;
    pass.filter(kept);
    for (const auto i : kept)
        result.value[static_cast<std::size_t>(i)] = 1;
    return result;
}

Timed<Mask> stock_outliers(const StockCloud& cloud, int neighbours, double factor) {
    Timed<Mask> result{Mask(cloud.state().cloud->size(), 0)};
    pcl::StatisticalOutlierRemoval<Point> removal(true);
    pcl::Indices kept;
    const double start = thread_seconds();
    removal.setInputCloud(cloud.state().cloud);
    removal.setMeanK(neighbours);
    removal.setStddevMulThresh(factor);
    removal.filter(kept);
    result.ms = 1e3 * (thread_seconds() - start);
    for (const auto i : *removal.getRemovedIndices())
        result.value[static_cast<std::size_t>(i)] = 1;
    return result;
}

Timed<Vectors> stock_smoothed(const StockCloud& cloud, double radius_m, int order) {
    Timed<Vectors> result{Vectors(cloud.state().cloud->size(), kNone)};
    pcl::MovingLeastSquares<Point, Point> smoothing;
    pcl::PointCloud<Point> moved;
    // Its search in a picture takes no point that is none.
    const pcl::IndicesPtr seen(new pcl::Indices);
    for (std::size_t i = 0; i < cloud.state().cloud->size(); ++i)
        if (pcl::isFinite((*cloud.state().cloud)[i])) seen->push_back(static_cast<int>(i));
    const double start = thread_seconds();
    smoothing.setInputCloud(cloud.state().cloud);
    smoothing.setIndices(seen);
    smoothing.setSearchRadius(radius_m);
    smoothing.setPolynomialOrder(order);
    smoothing.setNumberOfThreads(1);
    smoothing.process(moved);
    result.ms = 1e3 * (thread_seconds() - start);
    const auto from = smoothing.getCorrespondingIndices();
    for (std::size_t k = 0; k < moved.size(); ++k)
        result.value[static_cast<std::size_t>(from->indices[k])] = moved[k].getVector3fMap();
    return result;
}

Timed<Vectors> stock_normals(const StockCloud& cloud, StockNormals method, double size_px) {
    using Estimation = pcl::IntegralImageNormalEstimation<Point, pcl::Normal>;
    Timed<Vectors> result{Vectors(cloud.state().cloud->size(), kNone)};
    pcl::PointCloud<pcl::Normal> normals;
    const double start = thread_seconds();
    Estimation estimation;
    estimation.setNormalEstimationMethod(
        method == StockNormals::covariance ? Estimation::COVARIANCE_MATRIX
        : method == StockNormals::gradient ? Estimation::AVERAGE_3D_GRADIENT
                                           : Estimation::AVERAGE_DEPTH_CHANGE
    );
    estimation.setNormalSmoothingSize(static_cast<float>(size_px));
    estimation.setInputCloud(cloud.state().cloud);
    estimation.compute(normals);
    result.ms = 1e3 * (thread_seconds() - start);
    for (std::size_t i = 0; i < normals.size(); ++i)
        result.value[i] = normals[i].getNormalVector3fMap();
    return result;
}

Timed<Mask> stock_octree_change(
    const StockCloud& reference, const StockCloud& cloud, double voxel_m, int least_points
) {
    Timed<Mask> result{Mask(cloud.state().cloud->size(), 0)};
    pcl::octree::OctreePointCloudChangeDetector<Point> octree(voxel_m);
    octree.setInputCloud(reference.state().cloud);
    octree.addPointsFromInputCloud();
    octree.switchBuffers();
    pcl::Indices changed;
    const double start = thread_seconds();
    octree.setInputCloud(cloud.state().cloud);
    octree.addPointsFromInputCloud();
    octree.getPointIndicesFromNewVoxels(changed, static_cast<pcl::uindex_t>(least_points));
    result.ms = 1e3 * (thread_seconds() - start);
    for (const auto i : changed)
        result.value[static_cast<std::size_t>(i)] = 1;
    return result;
}

}  // namespace kinectlab::bench
