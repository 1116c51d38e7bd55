#include "pipeline/track/shape_pool.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr int kDraws = 64;  // samples between two looks at the best
constexpr std::size_t kFirstSubset = 256;
constexpr std::size_t kMostPooled = 48;      // candidates that are kept from draw to draw
constexpr std::array kReaches{2, 4, 8, 16};  // cells: neighbourhoods that samples are drawn from
constexpr double kSampleOdds = 1.0 / 16.0;   // that a sample from a shape's point is all its own

constexpr std::array kKinds{
    ShapeKind::plane, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone};

bool agrees(const Shape& shape, const OrientedPoint& point) {
    const Eigen::Vector3d out = outwards(shape, point.p_cam);
    const double norm = out.norm();
    if (!(out.dot(point.normal) >= 0.9 * norm)) return false;
    const double off =
        shape.kind == ShapeKind::plane
            ? height_on(shape, point.p_cam)
            : (out.dot(point.p_cam - shape.point) - quadric_of(shape).rho) / (2.0 * norm);
    return std::abs(off) <= 0.015 * point.p_cam.z();
}

}  // namespace

void ShapePool::begin() {
    pool_.clear();
    random_ = ShapeRandom{};
    draws_ = 0.0;
}

/// A point and neighbours of it, all from one part of the picture.
std::optional<ShapePool::Sample> ShapePool::draw_sample(
    const SurfacePoints& points, const ShapeGrid& grid
) {
    const std::size_t seed = random_.below(points.size);
    const auto cell = static_cast<int>(grid.cell_of(points.pixel[seed]));
    const int column = cell % grid.columns(), row = cell / grid.columns();
    const int reach = kReaches[random_.below(kReaches.size())];
    const auto span = static_cast<std::size_t>(2 * reach + 1);
    Sample sample;
    sample[0] = points.at(seed);
    for (std::size_t k = 1; k < sample.size(); ++k) {
        std::int32_t other = -1;
        for (int attempt = 0; attempt < 4 && other < 0; ++attempt) {
            const int c = column + static_cast<int>(random_.below(span)) - reach;
            const int r = row + static_cast<int>(random_.below(span)) - reach;
            if (c < 0 || r < 0 || c >= grid.columns() || r >= grid.rows() ||
                (c == column && r == row))
                continue;
            other = grid.point_in(static_cast<std::size_t>(r * grid.columns() + c));
        }
        if (other < 0) return std::nullopt;
        sample[k] = points.at(static_cast<std::size_t>(other));
    }
    return sample;
}

void ShapePool::draw(const SurfacePoints& points, const ShapeGrid& grid) {
    for (int i = 0; i < kDraws; ++i) {
        const auto sample = draw_sample(points, grid);
        if (!sample) continue;
        for (const auto kind : kKinds) {
            const auto k = static_cast<std::size_t>(kind);
            if (!rules_.kinds[k]) continue;
            const auto shape = propose(kind, *sample, rules_.limits[k]);
            if (!shape || !agrees(*shape, (*sample)[2]) || !agrees(*shape, (*sample)[3])) continue;
            Pooled one{*shape};
            look(one, kFirstSubset, points);
            if (one.bounds.high >= rules_.least_points) enter(one);
        }
    }
    draws_ += kDraws;
}

void ShapePool::look(Pooled& one, std::size_t until, const SurfacePoints& points) const {
    const std::size_t end = std::min(until, points.size);
    one.found += count_support(one.shape, points, one.seen, end, rules_.tolerance);
    one.seen = end;
    one.bounds = extrapolate(one.found, end, points.size);
}

void ShapePool::enter(const Pooled& one) {
    if (pool_.size() < kMostPooled) {
        pool_.push_back(one);
        return;
    }
    const auto worst =
        std::min_element(pool_.begin(), pool_.end(), [](const Pooled& a, const Pooled& b) {
            return a.bounds.middle < b.bounds.middle;
        });
    if (worst->bounds.middle < one.bounds.middle) *worst = one;
}

std::size_t ShapePool::sure_best(const SurfacePoints& points) {
    while (true) {
        std::size_t best = 0;
        for (std::size_t i = 1; i < pool_.size(); ++i)
            if (pool_[i].bounds.middle > pool_[best].bounds.middle) best = i;
        bool sure = true;
        const auto further = [&](Pooled& one) {
            if (one.seen >= points.size) return;
            look(one, 2 * one.seen, points);
            sure = false;
        };
        for (std::size_t i = 0; i < pool_.size(); ++i)
            if (i != best && pool_[i].bounds.high > pool_[best].bounds.low) further(pool_[i]);
        if (!sure || pool_.size() == 1) further(pool_[best]);
        if (sure) return best;
    }
}

bool ShapePool::may_have_missed(double support, std::size_t points) const {
    const double found = std::min(
        0.999, kSampleOdds * support / static_cast<double>(std::max<std::size_t>(1, points))
    );
    return std::log(rules_.miss_probability) < draws_ * std::log(1.0 - found);
}

Shape ShapePool::take(std::size_t i) {
    const Shape shape = pool_[i].shape;
    pool_.erase(pool_.begin() + static_cast<std::ptrdiff_t>(i));
    return shape;
}

void ShapePool::look_again(const SurfacePoints& points) {
    auto kept = pool_.begin();
    for (auto& one : pool_) {
        one.seen = 0;
        one.found = 0;
        look(one, kFirstSubset, points);
        if (one.bounds.high >= rules_.least_points) *kept++ = one;
    }
    pool_.erase(kept, pool_.end());
}

}  // namespace kinectlab
