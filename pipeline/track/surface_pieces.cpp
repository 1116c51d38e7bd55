#include "pipeline/track/surface_pieces.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace kinectlab {
namespace {

constexpr double kJump_sigmas = 5.0;
constexpr double kSlope_steps = 1.5;   // of disparity a pixel, a steep surface
constexpr double kSharedNoise = 10.0;  // pixels that err together in a Kinect's correlation window
constexpr double kOutline_px = 0.5;
constexpr double kDifferentLength = 1.5;  // ratio of the axes' variances: longer beyond doubt

}  // namespace

SurfacePieces::SurfacePieces(const RgbdCamera& camera)
    : width_(camera.depth.width), height_(camera.depth.height), scale_(camera) {
    pixels_.reserve(static_cast<std::size_t>(width_ * height_));
}

bool SurfacePieces::continuous(std::uint16_t a, std::uint16_t b) const {
    if (b == 0) return false;
    const double s = scale_.steps(a);
    return std::abs(s - scale_.steps(b)) <= kJump_sigmas * scale_.sigma_at(s) + kSlope_steps;
}

std::span<const std::span<const std::uint32_t>> SurfacePieces::cut(
    std::span<const std::uint16_t> depth, std::span<std::uint8_t> mask, std::size_t fewest
) {
    pixels_.clear();
    pieces_.clear();
    const auto size = static_cast<std::uint32_t>(mask.size());
    const auto width = static_cast<std::uint32_t>(width_);
    for (std::uint32_t start = 0; start < size; ++start) {
        if (mask[start] == 0) continue;
        mask[start] = 0;
        if (depth[start] == 0) continue;
        const std::size_t first = pixels_.size();
        pixels_.push_back(start);
        for (std::size_t next = first; next < pixels_.size(); ++next) {
            const std::uint32_t at = pixels_[next];
            const std::uint32_t column = at % width;
            const auto visit = [&](std::uint32_t to) {
                if (mask[to] == 0 || !continuous(depth[at], depth[to])) return;
                mask[to] = 0;
                pixels_.push_back(to);
            };
            if (column > 0) visit(at - 1);
            if (column + 1 < width) visit(at + 1);
            if (at >= width) visit(at - width);
            if (at + width < size) visit(at + width);
        }
        if (pixels_.size() - first < fewest)
            pixels_.resize(first);
        else
            pieces_.emplace_back(pixels_.data() + first, pixels_.size() - first);
    }
    std::sort(pieces_.begin(), pieces_.end(), [](const auto& a, const auto& b) {
        return a.size() > b.size();
    });
    return pieces_;
}

SurfaceMoments surface_moments(
    std::span<const std::uint16_t> depth,
    std::span<const std::uint32_t> pixels,
    const RgbdCamera& camera
) {
    const auto n = static_cast<double>(pixels.size());
    const auto point = [&](std::uint32_t pixel) -> Eigen::Vector3d {
        const int column = static_cast<int>(pixel) % camera.depth.width;
        const int row = static_cast<int>(pixel) / camera.depth.width;
        return camera.depth.ray(column, row) * (depth[pixel] * camera.depth_unit_m);
    };
    SurfaceMoments moments;
    for (const auto pixel : pixels)
        moments.centroid_cam += point(pixel);
    moments.centroid_cam /= n;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const auto pixel : pixels) {
        const Eigen::Vector3d off = point(pixel) - moments.centroid_cam;
        spread += off * off.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread / n);
    moments.variances = solver.eigenvalues().reverse().cwiseMax(0.0);
    moments.axes_cam = solver.eigenvectors().rowwise().reverse();
    if (moments.axes_cam.determinant() < 0.0) moments.axes_cam.col(2) *= -1.0;

    const DisparityScale scale(camera);
    const double z = moments.centroid_cam.z();
    const double s = scale.steps_at(z);
    const double sigma_z = z * scale.sigma_at(s) / s;
    const double pixel_m = z / camera.depth.fx;
    const Eigen::Vector3d ray = moments.centroid_cam / z;
    // One outline pixel in its place or not; √n pixels make an outline.
    const double outline = std::pow(kOutline_px * pixel_m, 2) / std::sqrt(n);
    const Eigen::Matrix3d noise =
        kSharedNoise / n * sigma_z * sigma_z * ray * ray.transpose() +
        outline * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal().toDenseMatrix();
    moments.centroid_covariance = noise;

    // First-order perturbation of eigenvectors: axes i and j turn into each other by their
    // cross-moment's noise over the difference of their variances.
    const Eigen::Matrix3d along = moments.axes_cam.transpose() * noise * moments.axes_cam;
    const Eigen::Vector3d& v = moments.variances;
    moments.axes_known =
        v[1] > 0.0 && v[0] >= kDifferentLength * v[1] && v[1] >= kDifferentLength * v[2];
    if (!moments.axes_known) return moments;
    Eigen::Vector3d turn;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double gap = v[i] - v[j];
        turn[k] = (along(i, i) * v[j] + along(j, j) * v[i]) / (gap * gap);
    }
    moments.turn_covariance = moments.axes_cam * turn.asDiagonal() * moments.axes_cam.transpose();
    return moments;
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
