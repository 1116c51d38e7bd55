#include "pipeline/track/outline_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinectlab {
namespace {

constexpr double kSharedNoise = 10.0;   // pixels that err together in a Kinect's correlation window
constexpr double kEdge_px = 0.5;        // an outline's pixel is in its place or not
constexpr double kEdgeShared_px = 7.0;  // so far along the outline they err together
constexpr int kSectors = 16;
constexpr double kExpectedCounts = 4.0;  // as many comparisons as the expectation is worth
constexpr double kMemory = 30.0;         // comparisons

int sector_of(const Eigen::Vector3d& off) {
    const double turn = std::atan2(off.y(), off.x()) / (2.0 * 3.14159265358979) + 0.5;
    return std::min(kSectors - 1, static_cast<int>(kSectors * turn));
}

}  // namespace

Eigen::Matrix3d readings_error(
    const Eigen::Vector3d& centroid_cam, double sigma_share, double squares, double mass
) {
    const Eigen::Vector3d along_ray = centroid_cam * sigma_share;
    return kSharedNoise * squares / (mass * mass) * along_ray * along_ray.transpose();
}

OutlineError::OutlineError(const Pinhole& lens)
    : lens_(lens), now_(static_cast<std::size_t>(lens.width * lens.height)), before_(now_.size()) {}

Eigen::Matrix3d OutlineError::covariance(
    Memory& memory,
    std::span<const Pixel> before,
    std::span<const Pixel> now,
    const Eigen::Vector3d& centroid_cam,
    double mass
) {
    for (const auto& one : now)
        now_[one.pixel] = one.weight;
    for (const auto& one : before)
        before_[one.pixel] = one.weight;
    const Eigen::Matrix3d expected_now = expected(now, centroid_cam, mass);
    if (!before.empty()) {
        memory.comparisons = std::min(kMemory, memory.comparisons + 1.0);
        memory.measured +=
            (changed(before, now, memory.centroid_cam, centroid_cam, mass) - memory.measured) /
            memory.comparisons;
    }
    memory.centroid_cam = centroid_cam;
    for (const auto& one : now)
        now_[one.pixel] = 0.0F;
    for (const auto& one : before)
        before_[one.pixel] = 0.0F;
    return (kExpectedCounts * expected_now + memory.comparisons * memory.measured) /
           (kExpectedCounts + memory.comparisons);
}

Eigen::Vector3d OutlineError::off(const Pixel& one, const Eigen::Vector3d& centroid_cam) const {
    const auto column = static_cast<int>(one.pixel) % lens_.width;
    const auto row = static_cast<int>(one.pixel) / lens_.width;
    return lens_.ray(column, row) * double{one.z} - centroid_cam;
}

Eigen::Matrix3d OutlineError::expected(
    std::span<const Pixel> now, const Eigen::Vector3d& centroid_cam, double mass
) const {
    const int width = lens_.width;
    const auto size = static_cast<std::int64_t>(now_.size());
    const auto inside = [&](std::int64_t pixel) {
        return pixel >= 0 && pixel < size && now_[static_cast<std::size_t>(pixel)] >= 0.5F;
    };
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto& one : now) {
        const std::int64_t at = one.pixel;
        if (one.weight < 0.5F ||
            (inside(at - 1) && inside(at + 1) && inside(at - width) && inside(at + width)))
            continue;
        const Eigen::Vector3d from_centroid = off(one, centroid_cam);
        sum += from_centroid * from_centroid.transpose();
    }
    return kEdge_px * kEdge_px * kEdgeShared_px / (mass * mass) * sum;
}

Eigen::Matrix3d OutlineError::changed(
    std::span<const Pixel> before,
    std::span<const Pixel> now,
    const Eigen::Vector3d& from_cam,
    const Eigen::Vector3d& to_cam,
    double mass
) const {
    const Eigen::Vector2d moved = lens_.project(to_cam) - lens_.project(from_cam);
    const std::int64_t shift = std::lround(moved.x()) + std::lround(moved.y()) * lens_.width;
    const auto size = static_cast<std::int64_t>(now_.size());
    const auto weight_at = [size](const std::vector<float>& weights, std::int64_t pixel) {
        return pixel < 0 || pixel >= size ? 0.0F : weights[static_cast<std::size_t>(pixel)];
    };
    std::array<Eigen::Vector3d, kSectors> change;
    change.fill(Eigen::Vector3d::Zero());
    const auto add = [&](const Eigen::Vector3d& from_centroid, float weight) {
        change[static_cast<std::size_t>(sector_of(from_centroid))] +=
            double{weight} * from_centroid;
    };
    for (const auto& one : now) {
        const float weight = one.weight - weight_at(before_, one.pixel - shift);
        if (weight != 0.0F) add(off(one, to_cam), weight);
    }
    for (const auto& one : before)
        if (weight_at(now_, one.pixel + shift) == 0.0F) add(off(one, from_cam), -one.weight);
    // The difference of two frames has twice the variance of one.
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto& sector : change)
        sum += sector * sector.transpose();
    return sum / (2.0 * mass * mass);
}

}  // namespace kinectlab
