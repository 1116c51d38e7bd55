#include "tests/bench/peer_ppf.hpp"

#ifdef KINECTLAB_PPF

#include <algorithm>

#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/ppf_helpers.hpp>

namespace kinectlab::bench {
namespace {

constexpr double kSampling = 0.05;  // of the diameter
constexpr double kReferencePoints =
    0.02;  // of the scene's; with five times as many it takes minutes
constexpr std::size_t kRefined = 5;

cv::Mat to_mat(const OrientedPoints& cloud) {
    cv::Mat mat(static_cast<int>(cloud.points.size()), 6, CV_32F);
    for (int i = 0; i < mat.rows; ++i) {
        const auto at = static_cast<std::size_t>(i);
        for (int k = 0; k < 3; ++k) {
            mat.at<float>(i, k) = cloud.points[at][k];
            mat.at<float>(i, 3 + k) = cloud.normals[at][k];
        }
    }
    return mat;
}

double largest_side(const OrientedPoints& cloud) {
    Eigen::Vector3f low = cloud.points.front(), high = low;
    for (const auto& p : cloud.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return (high - low).maxCoeff();
}

}  // namespace

struct PpfDetector::State {
    cv::Mat model;
    double side_m = 0.0;
    cv::ppf_match_3d::PPF3DDetector detector{kSampling, kSampling};
    cv::ppf_match_3d::ICP icp{100, 0.005F, 2.5F, 8};
};

PpfDetector::PpfDetector(const OrientedPoints& model) : state_(std::make_unique<State>()) {
    state_->model = to_mat(model);
    state_->side_m = largest_side(model);
    state_->detector.trainModel(state_->model);
}

PpfDetector::~PpfDetector() = default;

std::optional<Eigen::Isometry3d> PpfDetector::find(const OrientedPoints& scene) {
    if (scene.points.empty()) return std::nullopt;
    cv::Mat points = to_mat(scene);
    // It thins the scene to a share of the scene's own size: as densely as the model is needed.
    const double sampling = kSampling * state_->side_m / largest_side(scene);
    std::vector<cv::ppf_match_3d::Pose3DPtr> poses;
    state_->detector.match(points, poses, kReferencePoints, sampling);
    if (poses.empty()) return std::nullopt;
    if (poses.size() > kRefined) poses.resize(kRefined);
    state_->icp.registerModelToScene(state_->model, points, poses);
    const auto best =
        std::min_element(poses.begin(), poses.end(), [](const auto& a, const auto& b) {
            return a->residual < b->residual;
        });
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 4; ++k)
            T.matrix()(i, k) = (*best)->pose(i, k);
    return T;
}

bool PpfDetector::is_installed() {
    return true;
}

}  // namespace kinectlab::bench

#else

namespace kinectlab::bench {

struct PpfDetector::State {};
PpfDetector::PpfDetector(const OrientedPoints&) {}
PpfDetector::~PpfDetector() = default;

std::optional<Eigen::Isometry3d> PpfDetector::find(const OrientedPoints&) {
    return std::nullopt;
}

bool PpfDetector::is_installed() {
    return false;
}

}  // namespace kinectlab::bench

#endif
