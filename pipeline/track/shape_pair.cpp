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

/// The normals in heaps, begun from those that are farthest apart.
std::optional<std::array<Shape, PlanePair::kMost>> PlanePair::guess(
    const SurfacePoints& points, std::size_t faces
) {
    if (points.size < kFewestPoints) return std::nullopt;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size; ++i)
        middle += points.at(i).normal;
    std::array<Shape, kMost> planes;
    const auto likest = [&](const Eigen::Vector3d& normal, std::size_t count) {
        std::size_t best = 0;
        for (std::size_t k = 1; k < count; ++k)
            if (normal.dot(planes[k].axis) > normal.dot(planes[best].axis)) best = k;
        return best;
    };
    for (std::size_t k = 0; k < faces; ++k) {
        std::size_t found = 0;
        double least = 2.0 * static_cast<double>(points.size);
        for (std::size_t i = 0; i < points.size; ++i) {
            const Eigen::Vector3d normal = points.at(i).normal;
            const double cosine =
                k == 0 ? normal.dot(middle) : normal.dot(planes[likest(normal, k)].axis);
            if (cosine >= least) continue;
            least = cosine;
            found = i;
        }
        planes[k].axis = points.at(found).normal;
    }
    for (int turn = 0; turn < kTurns; ++turn) {
        std::array<OrientedPoint, kMost> sums;
        std::array<double, kMost> count{};
        for (auto& sum : sums)
            sum.p_cam = sum.normal = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < points.size; ++i) {
            const OrientedPoint point = points.at(i);
            const std::size_t k = likest(point.normal, faces);
            sums[k].p_cam += point.p_cam;
            sums[k].normal += point.normal;
            count[k] += 1.0;
        }
        for (std::size_t k = 0; k < faces; ++k) {
            if (count[k] == 0.0) return std::nullopt;
            planes[k].point = sums[k].p_cam / count[k];
            planes[k].axis = sums[k].normal.normalized();
        }
    }
    return planes;
}

double PlanePair::cost(
    const DisparityImage& image,
    std::span<const std::uint32_t> pixels,
    const SurfacePoints& points,
    int faces
) {
    const auto most = static_cast<std::size_t>(faces);
    auto planes = guess(points, most);
    if (!planes || pixels.empty()) return 1.0;
    const auto width = static_cast<std::uint32_t>(camera_.width);
    double loss = 0.0;
    for (int share = 0; share < kShares; ++share) {
        std::array<Eigen::Vector3d, kMost> slopes;
        for (std::size_t k = 0; k < most; ++k)
            slopes[k] = slope_of((*planes)[k], scale_);
        for (auto& own : shares_)
            own.clear();
        loss = 0.0;
        for (const auto pixel : pixels) {
            const Eigen::Vector3d ray = camera_.ray(pixel % width, pixel / width);
            const double s = image.at(pixel);
            double off = std::abs(s - slopes[0].dot(ray));
            std::size_t nearest = 0;
            for (std::size_t k = 1; k < most; ++k) {
                const double off_k = std::abs(s - slopes[k].dot(ray));
                if (off_k >= off) continue;
                off = off_k;
                nearest = k;
            }
            shares_[nearest].push_back(pixel);
            const double t = off / (kLastGateSigmas * scale_.sigma_at(s));
            loss += t < 1.0 ? 1.0 - std::pow(1.0 - t * t, 3) : 1.0;
        }
        if (share + 1 == kShares) break;
        for (std::size_t k = 0; k < most; ++k) {
            const auto fit = fitter_.fit(image, shares_[k], (*planes)[k], false);
            if (!fit) return 1.0;
            (*planes)[k] = fit->shape;
        }
    }
    return loss / static_cast<double>(pixels.size());
}

}  // namespace kinectlab
