#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/vector8.hpp"
#include "pipeline/preprocess/moving_least_squares.hpp"
#include "pipeline/preprocess/moving_least_squares_settings.hpp"
#include "pipeline/preprocess/point_tree.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

constexpr double kLeastPivot = 1e-4;  // of what it was before elimination: below is singular

/// Points about the one to be smoothed, in radii from it; zeros fill up the last eight.
struct Neighbours {
    std::array<float, kMostNeighbours + PointTree::kLeafSize + 8> x, y, z;
    int size = 0;
};

void gather(const PointTree& tree, Point3 from, float radius, Neighbours& found) {
    const float squared_radius = radius * radius;
    const float scale = 1.0F / radius;
    int size = 0;
    float limit = std::nextafter(squared_radius, 1e30F);  // the radius itself is still inside
    tree.visit_within(from, limit, [&](const PointTree::Leaf& leaf) {
        for (std::uint32_t i = leaf.begin; i < leaf.begin + leaf.count; ++i) {
            const float dx = tree.x()[i] - from.x, dy = tree.y()[i] - from.y;
            const float dz = tree.z()[i] - from.z;
            const auto to = static_cast<std::size_t>(size);
            found.x[to] = dx * scale;
            found.y[to] = dy * scale;
            found.z[to] = dz * scale;
            size += dx * dx + dy * dy + dz * dz <= squared_radius ? 1 : 0;
        }
        if (size >= kMostNeighbours) limit = -1.0F;
    });
    found.size = std::min(size, kMostNeighbours);
    for (auto i = static_cast<std::size_t>(found.size); i % 8 != 0; ++i)
        found.x[i] = found.y[i] = found.z[i] = 0.0F;
}

/// Σ x, y, z, xx, xy, xz, yy, yz, zz.
using Scatter = std::array<float, 9>;

KINECTLAB_HOT_LOOP Scatter scatter_of(const Neighbours& neighbours) {
    Float8 sums[9] = {};
    for (int i = 0; i < neighbours.size; i += 8) {
        const Float8 x = load8(neighbours.x.data() + i);
        const Float8 y = load8(neighbours.y.data() + i);
        const Float8 z = load8(neighbours.z.data() + i);
        sums[0] += x, sums[1] += y, sums[2] += z;
        sums[3] += x * x, sums[4] += x * y, sums[5] += x * z;
        sums[6] += y * y, sums[7] += y * z, sums[8] += z * z;
    }
    Scatter scatter{};
    for (std::size_t k = 0; k < 9; ++k)
        for (int lane = 0; lane < 8; ++lane)
            scatter[k] += sums[k][lane];
    return scatter;
}

/// The plane of least squares: its normal, two axes across, and its height over the point.
struct Plane {
    Eigen::Vector3f normal, u, v;
    float height;
};

Plane plane_of(const Neighbours& neighbours) {
    const Scatter s = scatter_of(neighbours);
    const double n = neighbours.size;
    const Eigen::Vector3d mean(s[0] / n, s[1] / n, s[2] / n);
    Eigen::Matrix3d matrix;
    matrix << s[3], s[4], s[5], s[4], s[6], s[7], s[5], s[7], s[8];
    matrix -= n * mean * mean.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(matrix);
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    const Eigen::Vector3d u = normal.unitOrthogonal();
    return {
        normal.cast<float>(),
        u.cast<float>(),
        normal.cross(u).cast<float>(),
        static_cast<float>(normal.dot(mean))};
}

/// Σθ u^k v^j for j + k <= 4 and Σθ f u^k v^j for j + k <= 2, at [j][k].
struct Moments {
    double of[5][5];
    double f[3][3];
};

KINECTLAB_HOT_LOOP Moments
moments_of(const Neighbours& neighbours, const Plane& plane, float squared_epsilon) {
    Float8 of[5][5] = {}, f[3][3] = {};
    const Float8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
    for (int i = 0; i < neighbours.size; i += 8) {
        const Float8 x = load8(neighbours.x.data() + i);
        const Float8 y = load8(neighbours.y.data() + i);
        const Float8 z = load8(neighbours.z.data() + i);
        const Float8 u = plane.u.x() * x + plane.u.y() * y + plane.u.z() * z;
        const Float8 v = plane.v.x() * x + plane.v.y() * y + plane.v.z() * z;
        const Float8 height =
            plane.normal.x() * x + plane.normal.y() * y + plane.normal.z() * z - plane.height;
        const Float8 theta = 1.0F / (u * u + v * v + squared_epsilon);
        const Mask8 there = lanes < static_cast<float>(neighbours.size - i);
        Float8 row = keep8(theta, there);  // θ v^j
        for (int j = 0; j <= 4; ++j) {
            Float8 term = row;
            for (int k = 0; j + k <= 4; ++k) {
                of[j][k] += term;
                if (j + k <= 2) f[j][k] += term * height;
                term *= u;
            }
            row *= v;
        }
    }
    Moments moments{};
    for (int j = 0; j <= 4; ++j)
        for (int k = 0; j + k <= 4; ++k)
            for (int lane = 0; lane < 8; ++lane) {
                moments.of[j][k] += of[j][k][lane];
                if (j + k <= 2) moments.f[j][k] += f[j][k][lane];
            }
    return moments;
}

/// Equation 4 by elimination, the constant last: all that is asked for is its coefficient.
template <std::size_t kSize>
std::optional<double> constant_of(
    const Moments& moments, const std::array<int, kSize>& ku, const std::array<int, kSize>& kv
) {
    double a[kSize][kSize], b[kSize];
    for (std::size_t i = 0; i < kSize; ++i) {
        for (std::size_t k = i; k < kSize; ++k)
            a[i][k] = moments.of[kv[i] + kv[k]][ku[i] + ku[k]];
        b[i] = moments.f[kv[i]][ku[i]];
    }
    for (std::size_t p = 0; p + 1 < kSize; ++p) {
        for (std::size_t i = p + 1; i < kSize; ++i) {
            const double factor = a[p][i] / a[p][p];
            const double before = a[i][i];
            for (std::size_t k = i; k < kSize; ++k)
                a[i][k] -= factor * a[p][k];
            b[i] -= factor * b[p];
            if (!(a[i][i] > kLeastPivot * before)) return std::nullopt;
        }
    }
    return b[kSize - 1] / a[kSize - 1][kSize - 1];
}

struct Height {
    double value;  ///< over the plane at the point's foot, radii
    std::uint8_t fitted;
};

Height fit(const Neighbours& neighbours, const Plane& plane, Basis basis, float squared_epsilon) {
    const Moments moments = moments_of(neighbours, plane, squared_epsilon);
    if (basis == Basis::quadratic && neighbours.size >= 12) {
        constexpr std::array ku{2, 0, 1, 1, 0, 0};
        constexpr std::array kv{0, 2, 1, 0, 1, 0};
        if (const auto value = constant_of<6>(moments, ku, kv)) return {*value, 2};
    }
    if (neighbours.size >= 6) {
        constexpr std::array ku{1, 0, 0};
        constexpr std::array kv{0, 1, 0};
        if (const auto value = constant_of<3>(moments, ku, kv)) return {*value, 1};
    }
    return {moments.f[0][0] / moments.of[0][0], 0};
}

}  // namespace

Result<Smoothed> smooth_unorganised(
    const Cloud& cloud, const MovingLeastSquaresSettings& settings
) {
    if (auto right = check_shape(cloud); !right) return tl::unexpected(right.error());
    if (auto right = check(settings); !right) return tl::unexpected(right.error());

    Smoothed result{cloud, std::vector<std::uint8_t>(cloud.size(), Smoothed::kNoFit)};
    const PointTree tree(cloud);
    const auto radius = static_cast<float>(settings.radius_m);
    const double epsilon = settings.epsilon_m / settings.radius_m;
    const auto squared_epsilon = static_cast<float>(epsilon * epsilon);
    Neighbours neighbours;
    for (const auto& leaf : tree.leaves()) {
        for (std::uint32_t place = leaf.begin; place < leaf.begin + leaf.count; ++place) {
            const Point3 from = tree.point(place);
            gather(tree, from, radius, neighbours);
            const std::uint32_t i = tree.index(place);
            result.fitted[i] = 0;
            if (neighbours.size < 3) continue;
            const Plane plane = plane_of(neighbours);
            const Height height = fit(neighbours, plane, settings.basis, squared_epsilon);
            result.fitted[i] = height.fitted;
            const auto along = radius * (plane.height + static_cast<float>(height.value));
            result.cloud.x[i] = from.x + along * plane.normal.x();
            result.cloud.y[i] = from.y + along * plane.normal.y();
            result.cloud.z[i] = from.z + along * plane.normal.z();
        }
    }
    return result;
}

}  // namespace kinectlab
