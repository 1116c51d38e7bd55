#include "pipeline/track/sphere_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinectlab {
namespace {

constexpr int kMaxTries = 64;
constexpr double kMissProbability = 1e-3;    // of never drawing two good points
constexpr double kToleranceSigmas = 4.0;     // ε: noise, and
constexpr double kToleranceOfRadius = 0.15;  // what a candidate from two points is off by
constexpr double kCosMaxAngle = 0.82;        // α = 35°: normals of small windows are rough
constexpr double kMinSine = 0.2;             // between two normals, else their lines are parallel
constexpr double kJumpSteps = 12.0;

/// Marsaglia's xorshift: a fixed seed makes every run of a recording the same.
class Random {
public:
    std::size_t below(std::size_t n) {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 17;
        state_ ^= state_ << 5;
        return state_ % n;
    }

private:
    std::uint32_t state_ = 2463534242U;
};

/// Half the window of the normals' fit: a quarter of the radius if all pixels were one disc, and
/// no more than a candidate needs.
int half_window_for(std::size_t pixels) {
    const double radius_px = std::sqrt(static_cast<double>(pixels) / std::numbers::pi);
    return static_cast<int>(std::clamp(radius_px / 4.0, 1.5, 3.5));
}

std::optional<Sphere> through(
    const OrientedPoint& a, const OrientedPoint& b, const SphereSettings& settings
) {
    // Closest points of the lines a + s·na and b + t·nb.
    const double cosine = a.normal.dot(b.normal);
    const double sine2 = 1.0 - cosine * cosine;
    if (sine2 < kMinSine * kMinSine) return std::nullopt;
    const Eigen::Vector3d ab = b.p_cam - a.p_cam;
    const double along_a = ab.dot(a.normal), along_b = ab.dot(b.normal);
    const double s = (along_a - cosine * along_b) / sine2;
    const double t = (cosine * along_a - along_b) / sine2;
    if (s >= 0.0 || t >= 0.0) return std::nullopt;  // the centre is behind the surface

    Sphere sphere;
    if (settings.radius_m) {
        sphere.radius = *settings.radius_m;
        sphere.centre_cam = 0.5 * (a.p_cam + b.p_cam) - 0.5 * sphere.radius * (a.normal + b.normal);
        return sphere;
    }
    sphere.centre_cam = 0.5 * (a.p_cam + s * a.normal + b.p_cam + t * b.normal);
    sphere.radius =
        0.5 * ((a.p_cam - sphere.centre_cam).norm() + (b.p_cam - sphere.centre_cam).norm());
    const bool in_range = sphere.radius >= 0.7 * settings.min_radius_m &&
                          sphere.radius <= 1.4 * settings.max_radius_m;
    return in_range ? std::optional(sphere) : std::nullopt;
}

}  // namespace

SurfaceSample::SurfaceSample(
    std::span<const std::uint16_t> depth,
    MovedPixels pixels,
    const Pinhole& camera,
    const DisparityScale& scale
) {
    const int half_window = half_window_for(pixels.size());
    const std::size_t count = std::min(kPoints, pixels.size());
    for (std::size_t k = 0; k < count; ++k) {
        // Evenly over the reading order, and so over the surface.
        const std::uint32_t pixel = pixels[(2 * k + 1) * pixels.size() / (2 * count)];
        const auto point = oriented_point(depth, camera, scale, pixel, half_window, kJumpSteps);
        if (point) points_[size_++] = *point;
    }
}

double support(
    const Sphere& sphere, std::span<const OrientedPoint> points, const DisparityScale& scale
) {
    if (points.empty()) return 0.0;
    int inliers = 0;
    for (const auto& point : points) {
        const Eigen::Vector3d ray = point.p_cam / point.p_cam.z();
        const RayHit hit = meet(ray, sphere);
        if (!hit.hits) continue;
        const double s = hit.w / scale.inverse_depth_step;
        const double off_m = kToleranceOfRadius * sphere.radius;
        const double tolerance = kToleranceSigmas * scale.sigma_at(s) + off_m * hit.w * s;
        const Eigen::Vector3d normal = (point.p_cam - sphere.centre_cam).normalized();
        const bool on_surface = std::abs(s - point.disparity) <= tolerance;
        if (on_surface && normal.dot(point.normal) >= kCosMaxAngle) ++inliers;
    }
    return static_cast<double>(inliers) / static_cast<double>(points.size());
}

std::optional<Sphere> sphere_candidate(
    std::span<const OrientedPoint> points,
    const SphereSettings& settings,
    const DisparityScale& scale
) {
    if (points.size() < 8) return std::nullopt;
    Random random;
    std::optional<Sphere> best;
    double best_support = 0.0;
    double tries_needed = kMaxTries;
    for (int i = 0; i < kMaxTries && i < tries_needed; ++i) {
        const auto& a = points[random.below(points.size())];
        const auto& b = points[random.below(points.size())];
        const auto sphere = through(a, b, settings);
        if (!sphere) continue;
        const double found = support(*sphere, points, scale);
        if (found <= best_support) continue;
        best_support = found;
        best = sphere;
        // Fischler & Bolles 1981: enough draws to have met two inliers all but surely.
        const double both = std::min(0.999, found * found);
        tries_needed = std::log(kMissProbability) / std::log(1.0 - both);
    }
    return best;
}

}  // namespace kinectlab
