#include "pipeline/track/shape_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/track/shape_sample.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kFewestPoints = 8;
constexpr double kMissProbability = 1e-3;  // of never drawing a sample of good points only
constexpr double kCosOwnNormal = 0.93;     // 21°: of a sample's normals to its own shape's

void keep_best(std::vector<ShapeCandidate>& best, std::size_t most, const ShapeCandidate& one) {
    if (best.size() == most && one.support <= best.back().support) return;
    if (best.size() == most) best.pop_back();
    const auto place = std::find_if(best.begin(), best.end(), [&](const ShapeCandidate& other) {
        return one.support > other.support;
    });
    best.insert(place, one);
}

}  // namespace

std::optional<Shape> propose(
    ShapeKind kind, std::span<const OrientedPoint> sample, const SizeLimits& limits
) {
    auto shape = through_sample(kind, sample);
    if (!shape) return std::nullopt;
    if (kind != ShapeKind::plane && !limits.may_be(shape->size)) return std::nullopt;
    const std::size_t used = sample_size(kind);
    for (std::size_t i = 0; i < used; ++i) {
        const Eigen::Vector3d normal = outwards(*shape, sample[i].p_cam).normalized();
        if (!(normal.dot(sample[i].normal) >= kCosOwnNormal)) return std::nullopt;
    }
    if (limits.known && kind != ShapeKind::plane) {
        shape->size = *limits.known;
        if (kind != ShapeKind::cone) {  // the centre lies one radius behind the points
            Eigen::Vector3d centre = Eigen::Vector3d::Zero();
            for (std::size_t i = 0; i < used; ++i)
                centre += sample[i].p_cam - shape->size * sample[i].normal;
            centre /= static_cast<double>(used);
            if (kind == ShapeKind::cylinder)
                centre -= shape->axis * shape->axis.dot(centre - shape->point);
            shape->point = centre;
        }
    }
    return shape;
}

void search_shape(
    ShapeKind kind,
    const SurfacePoints& points,
    const SizeLimits& limits,
    const Tolerance& tolerance,
    const SearchEffort& effort,
    std::vector<ShapeCandidate>& best
) {
    best.clear();
    if (points.size < kFewestPoints) return;
    ShapeRandom random(effort.seed);
    std::array<OrientedPoint, 3> sample;
    const std::size_t used = sample_size(kind);
    double needed = effort.most_tries;
    for (int i = 0; i < effort.most_tries && i < std::max<double>(effort.least_tries, needed);
         ++i) {
        for (std::size_t k = 0; k < used; ++k)
            sample[k] = points.at(random.below(points.size));
        const auto shape = propose(kind, sample, limits);
        if (!shape) continue;
        const int support = count_support(*shape, points, 0, points.size, tolerance);
        if (support < static_cast<int>(kFewestPoints) / 2) continue;
        keep_best(best, effort.most_found, {*shape, support});
        const double share =
            static_cast<double>(best.front().support) / static_cast<double>(points.size);
        // Two more points than needed: of good ones not every sample makes a good shape.
        const double all_good = std::min(0.999, std::pow(share, static_cast<double>(used) + 2.0));
        needed = std::log(kMissProbability) / std::log(1.0 - all_good);
    }
}

}  // namespace kinectlab
