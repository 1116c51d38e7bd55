#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "pipeline/preprocess/moving_least_squares.hpp"
#include "pipeline/preprocess/moving_least_squares_settings.hpp"
#include "pipeline/preprocess/point_tree.hpp"

namespace kinectlab {
namespace {

constexpr int kMostCoefficients = 6;
constexpr double kLeastPivot = 1e-6;  // of the greatest: below is singular

/// Points about the one to be smoothed, in metres from it.
using Neighbours = std::vector<Eigen::Vector3f>;

void gather(const PointTree& tree, Point3 from, float squared_radius, Neighbours& found) {
    found.clear();
    const Eigen::Vector3f origin(from.x, from.y, from.z);
    float limit = std::nextafter(squared_radius, 1e30F);  // the radius itself is still inside
    tree.visit_within(from, limit, [&](const PointTree::Leaf& leaf) {
        for (std::uint32_t place = leaf.begin; place < leaf.begin + leaf.count; ++place) {
            const Point3 p = tree.point(place);
            const Eigen::Vector3f offset = Eigen::Vector3f(p.x, p.y, p.z) - origin;
            if (offset.squaredNorm() <= squared_radius) found.push_back(offset);
            if (found.size() == kMostNeighbours) {
                limit = -1.0F;
                return;
            }
        }
    });
}

/// The plane of least squares: its axes, the normal first, and where the point's foot lies on it.
struct Plane {
    Eigen::Matrix3f axes;
    Eigen::Vector3f foot;
};

Plane plane_of(const Neighbours& neighbours) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const auto& p : neighbours)
        mean += p;
    mean /= static_cast<float>(neighbours.size());
    Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
    for (const auto& p : neighbours)
        scatter += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(scatter);
    const Eigen::Vector3f normal = solver.eigenvectors().col(0);
    return {solver.eigenvectors(), normal * normal.dot(mean)};
}

struct Height {
    double value = 0.0;  ///< m above the plane at the point's foot
    std::uint8_t fitted = 0;
};

/// Sums of equation 4: b bᵀ and b f with their weights.
class Fitter {
public:
    explicit Fitter(const MovingLeastSquaresSettings& settings)
        : settings_(settings), inverse_radius_(1.0 / settings.radius_m) {}

    Height fit(const Neighbours& neighbours, const Plane& plane) {
        matrix_.setZero();
        right_.setZero();
        const double epsilon = settings_.epsilon_m * settings_.epsilon_m;
        for (const auto& p : neighbours) {
            const Eigen::Vector3d local =
                (plane.axes.transpose() * (p - plane.foot)).cast<double>();
            const double theta = 1.0 / (local.tail<2>().squaredNorm() + epsilon);
            const double x = local.y() * inverse_radius_;
            const double y = local.z() * inverse_radius_;
            Eigen::Matrix<double, kMostCoefficients, 1> b;
            b << 1.0, x, y, x * y, x * x, y * y;
            matrix_.noalias() += (theta * b) * b.transpose();
            right_.noalias() += (theta * local.x()) * b;
        }
        const auto count = static_cast<int>(neighbours.size());
        if (settings_.basis == Basis::quadratic)
            if (const auto value = solve(6, count)) return {*value, 2};
        if (const auto value = solve(3, count)) return {*value, 1};
        return {right_[0] / matrix_(0, 0), 0};
    }

private:
    [[nodiscard]] std::optional<double> solve(int size, int count) const {
        if (count < 2 * size) return std::nullopt;
        const Eigen::MatrixXd matrix = matrix_.topLeftCorner(size, size);
        const Eigen::LDLT<Eigen::MatrixXd> solver(matrix);
        const auto pivots = solver.vectorD();
        if (!(pivots.minCoeff() > kLeastPivot * pivots.maxCoeff())) return std::nullopt;
        return solver.solve(right_.head(size))[0];
    }

    const MovingLeastSquaresSettings& settings_;
    double inverse_radius_;
    Eigen::Matrix<double, kMostCoefficients, kMostCoefficients> matrix_;
    Eigen::Matrix<double, kMostCoefficients, 1> right_;
};

}  // namespace

Result<Smoothed> smooth_unorganised(
    const Cloud& cloud, const MovingLeastSquaresSettings& settings
) {
    if (auto right = check_shape(cloud); !right) return tl::unexpected(right.error());
    if (auto right = check(settings); !right) return tl::unexpected(right.error());

    Smoothed result{cloud, std::vector<std::uint8_t>(cloud.size(), Smoothed::kNoFit)};
    const PointTree tree(cloud);
    const auto squared_radius = static_cast<float>(settings.radius_m * settings.radius_m);
    Fitter fitter(settings);
    Neighbours neighbours;
    for (const auto& leaf : tree.leaves()) {
        for (std::uint32_t place = leaf.begin; place < leaf.begin + leaf.count; ++place) {
            const Point3 from = tree.point(place);
            gather(tree, from, squared_radius, neighbours);
            const std::uint32_t i = tree.index(place);
            result.fitted[i] = 0;
            if (neighbours.size() < 3) continue;
            const Plane plane = plane_of(neighbours);
            const Height height = fitter.fit(neighbours, plane);
            result.fitted[i] = height.fitted;
            const Eigen::Vector3f moved =
                plane.foot + plane.axes.col(0) * static_cast<float>(height.value);
            result.cloud.x[i] = from.x + moved.x();
            result.cloud.y[i] = from.y + moved.y();
            result.cloud.z[i] = from.z + moved.z();
        }
    }
    return result;
}

}  // namespace kinectlab
