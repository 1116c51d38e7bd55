#include "tests/bench/peer_particle_filter.hpp"

#include <pcl/point_types.h>
#include <pcl/search/octree.h>
#include <pcl/tracking/approx_nearest_pair_point_cloud_coherence.h>
#include <pcl/tracking/distance_coherence.h>
#include <pcl/tracking/kld_adaptive_particle_filter_omp.h>

namespace kinectlab::bench {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Particle = pcl::tracking::ParticleXYZRPY;
// PCL 1.13 moves its particles in the OpenMP class alone: the other one never sees a change.
using Filter = pcl::tracking::KLDAdaptiveParticleFilterOMPTracker<Point, Particle>;

constexpr int kParticles = 600;
constexpr double kMargin = 0.15;  // m, of the region around the object that is looked at

Cloud::Ptr region_of(
    const RgbdCamera& camera, const RgbdFrame& frame, const Eigen::Vector3d& about
) {
    auto cloud = std::make_shared<Cloud>();
    for (int v = 0; v < camera.depth.height; v += 2)
        for (int u = 0; u < camera.depth.width; u += 2) {
            const auto depth = frame.depth[static_cast<std::size_t>(v * camera.depth.width + u)];
            if (depth == 0) continue;
            const Eigen::Vector3d p = camera.depth.ray(u, v) * (depth * camera.depth_unit_m);
            if ((p - about).cwiseAbs().maxCoeff() > kMargin) continue;
            const Eigen::Vector3f near = p.cast<float>();
            cloud->push_back({near.x(), near.y(), near.z()});
        }
    return cloud;
}

}  // namespace

struct ParticleFilter::State {
    State(const RgbdCamera& own, const Eigen::Isometry3d& T) : camera(own), last(T) {}
    RgbdCamera camera;
    Eigen::Isometry3d last;
    Filter filter;
};

ParticleFilter::ParticleFilter(
    const RgbdCamera& camera,
    const std::vector<Eigen::Vector3f>& surface,
    const Eigen::Isometry3d& T_cam_obj
)
    : state_(std::make_unique<State>(camera, T_cam_obj)) {
    auto& filter = state_->filter;
    filter.setNumberOfThreads(1);
    const std::vector<double> step = {
        0.015 * 0.015, 0.015 * 0.015, 0.015 * 0.015, 0.04 * 0.04, 0.04 * 0.04, 0.04 * 0.04};
    Particle bin;
    bin.x = bin.y = bin.z = bin.roll = bin.pitch = bin.yaw = 0.1F;
    filter.setMaximumParticleNum(kParticles);
    filter.setDelta(0.99);
    filter.setEpsilon(0.2);
    filter.setBinSize(bin);
    filter.setTrans(Eigen::Affine3f(T_cam_obj.cast<float>().matrix()));
    filter.setStepNoiseCovariance(step);
    filter.setInitialNoiseCovariance(std::vector<double>(6, 0.00001));
    filter.setInitialNoiseMean(std::vector<double>(6, 0.0));
    filter.setIterationNum(1);
    filter.setParticleNum(kParticles);
    filter.setResampleLikelihoodThr(0.0);
    filter.setUseNormal(false);
    auto coherence = std::make_shared<pcl::tracking::ApproxNearestPairPointCloudCoherence<Point>>();
    coherence->addPointCoherence(std::make_shared<pcl::tracking::DistanceCoherence<Point>>());
    coherence->setSearchMethod(std::make_shared<pcl::search::Octree<Point>>(0.01));
    coherence->setMaximumDistance(0.01);
    filter.setCloudCoherence(coherence);
    auto reference = std::make_shared<Cloud>();
    for (const auto& point : surface)
        reference->push_back({point.x(), point.y(), point.z()});
    filter.setReferenceCloud(reference);
}

ParticleFilter::~ParticleFilter() = default;

Eigen::Isometry3d ParticleFilter::track(const RgbdFrame& frame) {
    state_->filter.setInputCloud(region_of(state_->camera, frame, state_->last.translation()));
    state_->filter.compute();
    const Eigen::Affine3f found = state_->filter.toEigenMatrix(state_->filter.getResult());
    state_->last = Eigen::Isometry3d(found.matrix().cast<double>());
    return state_->last;
}

}  // namespace kinectlab::bench
