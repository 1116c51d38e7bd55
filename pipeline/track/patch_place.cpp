#include "pipeline/track/patch_place.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "pipeline/core/disparity.hpp"

namespace kinectlab {
namespace {

constexpr double kWanderCounts = 4.0;     // as many comparisons as the expectation is worth
constexpr double kDifferentLength = 1.5;  // ratio of the axes' variances: longer beyond doubt
constexpr double kHiddenShare = 0.1;      // less missing than this is noise
constexpr double kUsualMemory = 0.05;     // of the usual area is renewed in each frame

double weight_of(double vote, double half_vote) {
    return std::clamp(vote / half_vote - 0.5, 0.0, 1.0);
}

}  // namespace

PatchPlace::PatchPlace(const RgbdCamera& camera) : camera_(camera), outline_(camera.depth) {}

void PatchPlace::lose() {
    before_.clear();
}

void PatchPlace::forget() {
    lose();
    memory_ = {};
    wander_.setZero();
    usual_area_m2_ = 0.0;
}

Eigen::Vector3d PatchPlace::point(const RgbdFrame& frame, std::uint32_t pixel) const {
    const int column = static_cast<int>(pixel) % camera_.depth.width;
    const int row = static_cast<int>(pixel) / camera_.depth.width;
    return camera_.depth.ray(column, row) * (frame.depth[pixel] * camera_.depth_unit_m);
}

PatchPlace::Glance PatchPlace::glance(const RgbdFrame& frame, std::span<const std::uint32_t> pixels)
    const {
    Glance glance;
    for (const auto pixel : pixels) {
        const Eigen::Vector3d p = point(frame, pixel);
        glance.centroid_cam += p;
        glance.area_m2 += p.z() * p.z() / (camera_.depth.fx * camera_.depth.fy);
    }
    glance.centroid_cam /= static_cast<double>(pixels.size());
    return glance;
}

PatchPlace::Place PatchPlace::measure(
    const RgbdFrame& frame,
    std::span<const std::uint32_t> pixels,
    std::span<const std::uint8_t> votes,
    double half_vote
) {
    Place place;
    const auto centroid_at = [&](double half, double& mass) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        mass = 0.0;
        for (const auto pixel : pixels) {
            const double weight = weight_of(votes[pixel], half);
            mass += weight;
            sum += weight * point(frame, pixel);
        }
        return Eigen::Vector3d(sum / std::max(mass, 1e-9));
    };
    double mass = 0.0, other_mass = 0.0;
    const Eigen::Vector3d more = centroid_at((1.0 - kCommonMode) * half_vote, other_mass);
    const Eigen::Vector3d less = centroid_at((1.0 + kCommonMode) * half_vote, other_mass);
    place.centroid_cam = centroid_at(half_vote, mass);

    now_.clear();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    double squares = 0.0;
    for (const auto pixel : pixels) {
        const double weight = weight_of(votes[pixel], half_vote);
        if (weight <= 0.0) continue;
        const Eigen::Vector3d p = point(frame, pixel);
        const Eigen::Vector3d off = p - place.centroid_cam;
        spread += weight * off * off.transpose();
        squares += weight * weight;
        place.area_m2 += weight * p.z() * p.z() / (camera_.depth.fx * camera_.depth.fy);
        now_.push_back({pixel, static_cast<float>(weight), static_cast<float>(p.z())});
    }
    place.points = static_cast<int>(now_.size());
    spread /= std::max(mass, 1e-9);

    const DisparityScale scale(camera_);
    const double z = place.centroid_cam.z();
    const double s = scale.steps_at(z);
    const Eigen::Vector3d common = 0.5 * (more - less);
    place.covariance =
        readings_error(place.centroid_cam, scale.sigma_at(s) / s, squares, mass) +
        outline_.covariance(memory_, before_, now_, place.centroid_cam, mass) +
        common * common.transpose() +
        kWanderCounts / (kWanderCounts + memory_.comparisons) * wander_ * wander_.transpose();

    usual_area_m2_ = usual_area_m2_ > 0.0
                         ? usual_area_m2_ + kUsualMemory * (place.area_m2 - usual_area_m2_)
                         : place.area_m2;
    const double missing = 1.0 - place.area_m2 / usual_area_m2_;
    if (missing > kHiddenShare) place.covariance += missing * missing * spread;
    keep_axes(place, spread);

    std::swap(now_, before_);
    return place;
}

void PatchPlace::keep_axes(Place& place, const Eigen::Matrix3d& spread) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    const Eigen::Vector3d v = solver.eigenvalues().reverse().cwiseMax(0.0);
    place.axes_cam = solver.eigenvectors().rowwise().reverse();
    if (place.axes_cam.determinant() < 0.0) place.axes_cam.col(2) *= -1.0;
    place.axes_known =
        v[1] > 0.0 && v[0] >= kDifferentLength * v[1] && v[1] >= kDifferentLength * v[2];
    if (!place.axes_known) return;
    // First-order perturbation of eigenvectors: axes i and j turn into each other by their
    // cross-moment's noise over the difference of their variances.
    const Eigen::Matrix3d along = place.axes_cam.transpose() * place.covariance * place.axes_cam;
    Eigen::Vector3d turn;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double gap = v[i] - v[j];
        turn[k] = (along(i, i) * v[j] + along(j, j) * v[i]) / (gap * gap);
    }
    place.turn_covariance = place.axes_cam * turn.asDiagonal() * place.axes_cam.transpose();
}

Eigen::Matrix3d nearest_signs(const Eigen::Matrix3d& axes_cam, const Eigen::Matrix3d& before_cam) {
    Eigen::Matrix3d best = axes_cam;
    double most = -4.0;
    for (const double a : {1.0, -1.0})
        for (const double b : {1.0, -1.0}) {
            const Eigen::Matrix3d signs = axes_cam * Eigen::Vector3d(a, b, a * b).asDiagonal();
            const double trace = (signs * before_cam.transpose()).trace();
            if (trace <= most) continue;
            most = trace;
            best = signs;
        }
    return best;
}

}  // namespace kinectlab
