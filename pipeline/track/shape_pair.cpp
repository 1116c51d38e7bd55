#include "pipeline/track/shape_pair.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr std::size_t kFewestPoints = 8;
constexpr int kTurns = 6;   // of the normals between two middles
constexpr int kShares = 4;  // of the pixels between two planes

/// Disparity along a ray that a plane asks for: s = m·d.
Eigen::Vector3d slope_of(const Shape& plane, const DisparityScale& scale) {
    return plane.axis / (plane.axis.dot(plane.point) * scale.inverse_depth_step);
}

}  // namespace

PlanePair::PlanePair(const RgbdCamera& camera)
    : camera_(camera.depth), scale_(camera), fitter_(camera) {}

/// The normals in two heaps, begun from the two that are farthest apart.
std::optional<std::array<Shape, 2>> PlanePair::guess(const SurfacePoints& points) {
    if (points.size < kFewestPoints) return std::nullopt;
    const auto farthest_from = [&](const Eigen::Vector3d& normal) {
        std::size_t found = 0;
        for (std::size_t i = 1; i < points.size; ++i)
            if (points.at(i).normal.dot(normal) < points.at(found).normal.dot(normal)) found = i;
        return points.at(found).normal;
    };
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size; ++i)
        middle += points.at(i).normal;
    std::array<Shape, 2> planes;
    planes[0].axis = farthest_from(middle);
    planes[1].axis = farthest_from(planes[0].axis);
    for (int turn = 0; turn < kTurns; ++turn) {
        std::array<OrientedPoint, 2> sums;
        std::array<double, 2> count{};
        for (auto& sum : sums)
            sum.p_cam = sum.normal = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < points.size; ++i) {
            const OrientedPoint point = points.at(i);
            const std::size_t k =
                point.normal.dot(planes[1].axis) > point.normal.dot(planes[0].axis) ? 1 : 0;
            sums[k].p_cam += point.p_cam;
            sums[k].normal += point.normal;
            count[k] += 1.0;
        }
        for (std::size_t k = 0; k < 2; ++k) {
            if (count[k] == 0.0) return std::nullopt;
            planes[k].point = sums[k].p_cam / count[k];
            planes[k].axis = sums[k].normal.normalized();
        }
    }
    return planes;
}

double PlanePair::cost(
    const DisparityImage& image, std::span<const std::uint32_t> pixels, const SurfacePoints& points
) {
    auto planes = guess(points);
    if (!planes || pixels.empty()) return 1.0;
    const auto width = static_cast<std::uint32_t>(camera_.width);
    double loss = 0.0;
    for (int share = 0; share < kShares; ++share) {
        const std::array slopes{slope_of((*planes)[0], scale_), slope_of((*planes)[1], scale_)};
        for (auto& own : shares_)
            own.clear();
        loss = 0.0;
        for (const auto pixel : pixels) {
            const Eigen::Vector3d ray = camera_.ray(pixel % width, pixel / width);
            const double s = image.at(pixel);
            const double off_0 = std::abs(s - slopes[0].dot(ray));
            const double off_1 = std::abs(s - slopes[1].dot(ray));
            shares_[off_1 < off_0 ? 1 : 0].push_back(pixel);
            const double t = std::min(off_0, off_1) / (kLastGateSigmas * scale_.sigma_at(s));
            loss += t < 1.0 ? 1.0 - std::pow(1.0 - t * t, 3) : 1.0;
        }
        if (share + 1 == kShares) break;
        for (std::size_t k = 0; k < 2; ++k) {
            const auto fit = fitter_.fit(image, shares_[k], (*planes)[k], false);
            if (!fit) return 1.0;
            (*planes)[k] = fit->shape;
        }
    }
    return loss / static_cast<double>(pixels.size());
}

}  // namespace kinectlab
