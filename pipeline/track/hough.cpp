#include "pipeline/track/hough.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Geometry>

namespace kinectlab {
namespace {

constexpr std::size_t kFewestPoints = 8;
constexpr int kDirections = 800;     // over the half sphere that faces the camera: 5° apart
constexpr double kCosReach = 0.985;  // 10°: directions that a normal votes for
constexpr double kOffset_m = 0.01;   // of a plane, one cell
constexpr double kFarthest_m = 8.0;
constexpr int kRadii = 12;             // between the limits, in equal ratios
constexpr double kCellOfRadius = 0.3;  // of a centre's cell
constexpr double kSame = 0.5;          // of a cell: peaks closer to a better one are its flank

/// Directions spread evenly, as a sunflower sets its seeds; z towards the camera.
std::vector<Eigen::Vector3f> directions() {
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    std::vector<Eigen::Vector3f> all;
    for (int i = 0; i < kDirections; ++i) {
        const double z = -(i + 0.5) / kDirections, across = std::sqrt(1.0 - z * z);
        all.emplace_back(
            static_cast<float>(across * std::cos(golden * i)),
            static_cast<float>(across * std::sin(golden * i)),
            static_cast<float>(z)
        );
    }
    return all;
}

void rank(
    const SurfacePoints& points,
    const Tolerance& tolerance,
    std::size_t most,
    std::vector<ShapeCandidate>& best
) {
    for (auto& candidate : best)
        candidate.support = count_support(candidate.shape, points, 0, points.size, tolerance);
    std::stable_sort(best.begin(), best.end(), [](const auto& a, const auto& b) {
        return a.support > b.support;
    });
    if (best.size() > most) best.resize(most);
}

struct Cell {
    std::uint64_t key;
    int votes;
};

/// Votes by cell, in a table with open addresses: most of the time goes into casting them.
class Votes {
public:
    /// Room for so many cells, all without votes.
    void begin(std::size_t cells) { table_.assign(std::bit_ceil(2 * cells), Cell{kNoKey, 0}); }
    void add(std::uint64_t key) {
        const std::size_t mask = table_.size() - 1;
        std::size_t at = (key * 0x9E3779B97F4A7C15U >> 32) & mask;
        while (table_[at].key != key && table_[at].key != kNoKey)
            at = (at + 1) & mask;
        table_[at].key = key;
        ++table_[at].votes;
    }
    /// The cells with most votes; none with fewer than three.
    [[nodiscard]] std::vector<Cell> peaks(std::size_t most) const {
        std::vector<Cell> cells;
        for (const Cell& cell : table_)
            if (cell.votes >= 3) cells.push_back(cell);
        const auto better = [](const Cell& a, const Cell& b) {
            return a.votes != b.votes ? a.votes > b.votes : a.key < b.key;
        };
        const auto end = cells.begin() + static_cast<std::ptrdiff_t>(std::min(most, cells.size()));
        std::partial_sort(cells.begin(), end, cells.end(), better);
        cells.erase(end, cells.end());
        return cells;
    }

private:
    static constexpr std::uint64_t kNoKey = ~std::uint64_t{0};
    std::vector<Cell> table_;
};

/// A big ball finds as many points on a wall as a small one on itself, but far fewer of those that
/// its own face would show: what counts is the support times the share of that face. The points are
/// spread evenly over the picture, where the face covers (r/Z)² of some unit.
void rank_balls(
    const SurfacePoints& points,
    const Tolerance& tolerance,
    std::size_t most,
    std::vector<ShapeCandidate>& best
) {
    rank(points, tolerance, best.size(), best);
    const auto worth = [](const ShapeCandidate& one) {
        const double size_seen = one.shape.size / std::max(0.1, one.shape.point.z());
        return std::pow(one.support / size_seen, 2);
    };
    std::stable_sort(best.begin(), best.end(), [&](const auto& a, const auto& b) {
        return worth(a) > worth(b);
    });
    if (best.size() > most) best.resize(most);
}

}  // namespace

void hough_planes(
    const SurfacePoints& points,
    const Tolerance& tolerance,
    std::size_t most,
    std::vector<ShapeCandidate>& best
) {
    best.clear();
    if (points.size < kFewestPoints) return;
    static const std::vector<Eigen::Vector3f> kAll = directions();
    constexpr int kOffsets = static_cast<int>(kFarthest_m / kOffset_m);
    std::vector<std::uint16_t> votes(static_cast<std::size_t>(kDirections) * kOffsets);
    for (std::size_t i = 0; i < points.size; ++i) {
        const Eigen::Vector3f p(points.px[i], points.py[i], points.pz[i]);
        const Eigen::Vector3f n(points.nx[i], points.ny[i], points.nz[i]);
        for (std::size_t k = 0; k < kAll.size(); ++k) {
            if (kAll[k].dot(n) < kCosReach) continue;
            const auto offset = static_cast<int>(-kAll[k].dot(p) / static_cast<float>(kOffset_m));
            if (offset < 0 || offset >= kOffsets) continue;
            auto& cell = votes[k * kOffsets + static_cast<std::size_t>(offset)];
            if (cell < UINT16_MAX) ++cell;
        }
    }
    std::vector<std::size_t> cells(votes.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i] = i;
    const std::size_t looked_at = std::min<std::size_t>(16 * most, cells.size());
    std::partial_sort(
        cells.begin(),
        cells.begin() + static_cast<std::ptrdiff_t>(looked_at),
        cells.end(),
        [&](std::size_t a, std::size_t b) {
            return votes[a] != votes[b] ? votes[a] > votes[b] : a < b;
        }
    );
    for (std::size_t i = 0; i < looked_at && votes[cells[i]] > 0; ++i) {
        const Eigen::Vector3d n = kAll[cells[i] / kOffsets].cast<double>();
        const double offset = (static_cast<double>(cells[i] % kOffsets) + 0.5) * kOffset_m;
        // A cell is wide: its plane goes through the middle of the points that voted for it.
        Eigen::Vector3d middle = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
        double count = 0.0;
        for (std::size_t k = 0; k < points.size; ++k) {
            const OrientedPoint point = points.at(k);
            if (point.normal.dot(n) < kCosReach ||
                std::abs(n.dot(point.p_cam) + offset) > kOffset_m)
                continue;
            middle += point.p_cam;
            normal += point.normal;
            count += 1.0;
        }
        if (count < 3.0) continue;
        best.push_back({{ShapeKind::plane, middle / count, normal.normalized(), 0.0}, 0});
    }
    rank(points, tolerance, most, best);
}

void hough_spheres(
    const SurfacePoints& points,
    const SizeLimits& limits,
    const Tolerance& tolerance,
    std::size_t most,
    std::vector<ShapeCandidate>& best
) {
    best.clear();
    if (points.size < kFewestPoints) return;
    const int radii = limits.known ? 1 : kRadii;
    const double first = limits.known ? *limits.known : limits.least;
    const double ratio =
        limits.known ? 1.0 : std::pow(limits.most / limits.least, 1.0 / (kRadii - 1));
    double radius = first;
    Votes votes;
    for (int r = 0; r < radii; ++r, radius *= ratio) {
        const double cell_m = kCellOfRadius * radius;
        votes.begin(8 * points.size);
        for (std::size_t i = 0; i < points.size; ++i) {
            const OrientedPoint point = points.at(i);
            const Eigen::Vector3d centre = (point.p_cam - radius * point.normal) / cell_m;
            // Each point votes for the eight cells around its centre, so that none falls between.
            for (int corner = 0; corner < 8; ++corner) {
                std::uint64_t key = 0;
                for (int axis = 0; axis < 3; ++axis) {
                    const auto cell = static_cast<std::int64_t>(std::floor(centre[axis] - 0.5)) +
                                      ((corner >> axis) & 1) + (1 << 19);
                    key = key << 20 | (static_cast<std::uint64_t>(cell) & 0xFFFFF);
                }
                votes.add(key);
            }
        }
        for (const Cell& cell : votes.peaks(2 * most)) {
            Eigen::Vector3d middle;
            for (int axis = 2, shift = 0; axis >= 0; --axis, shift += 20)
                middle[axis] =
                    cell_m * (static_cast<double>((cell.key >> shift) & 0xFFFFF) - (1 << 19) + 0.5);
            // The mean of the centres that voted for it.
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            double count = 0.0;
            for (std::size_t i = 0; i < points.size; ++i) {
                const OrientedPoint point = points.at(i);
                const Eigen::Vector3d centre = point.p_cam - radius * point.normal;
                if ((centre - middle).cwiseAbs().maxCoeff() > cell_m) continue;
                sum += centre;
                count += 1.0;
            }
            if (count < 3.0) continue;
            const Eigen::Vector3d centre = sum / count;
            const bool flank = std::any_of(best.begin(), best.end(), [&](const auto& other) {
                return other.shape.size == radius &&
                       (other.shape.point - centre).norm() < kSame * cell_m;
            });
            if (!flank)
                best.push_back({{ShapeKind::sphere, centre, -Eigen::Vector3d::UnitZ(), radius}, 0});
        }
    }
    rank_balls(points, tolerance, most, best);
}

}  // namespace kinectlab
