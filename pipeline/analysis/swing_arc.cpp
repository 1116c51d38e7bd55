#include "pipeline/analysis/swing_arc.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "pipeline/analysis/median.hpp"

namespace kinectlab {

ArcCurvature arc_curvature(std::span<const PositionSample> samples) {
    const auto n = static_cast<Eigen::Index>(samples.size());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& s : samples)
        mean += s.p_lab / static_cast<double>(n);
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const auto& s : samples) {
        const Eigen::Vector2d d = (s.p_lab - mean).head<2>();
        spread += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(spread);
    const Eigen::Vector2d along = eigen.eigenvectors().col(1);
    const double reach = std::sqrt(eigen.eigenvalues()[1] / static_cast<double>(n));
    if (!(reach > 0.0)) return {};

    Eigen::Matrix<double, Eigen::Dynamic, 3> basis(n, 3);
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Vector3d d = samples[static_cast<std::size_t>(i)].p_lab - mean;
        const double u = d.head<2>().dot(along) / reach;
        basis.row(i) << 1.0, u, u * u;
        z[i] = d.z();
    }
    Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(n);
    Eigen::Vector3d c;
    Eigen::Matrix3d inverse;
    double scatter = 0.0;
    for (int round = 0; round < 6; ++round) {
        const Eigen::Matrix<double, Eigen::Dynamic, 3> weighted = basis.array().colwise() * weight;
        inverse = (weighted.transpose() * basis).ldlt().solve(Eigen::Matrix3d::Identity());
        c = inverse * (weighted.transpose() * z);
        const Eigen::ArrayXd miss = (z - basis * c).array().abs();
        scatter = std::max(median({miss.begin(), miss.end()}) / 0.6745, 1e-12);
        weight = (2.0 * scatter / miss.max(1e-15)).min(1.0);
    }
    const double scale = 1.0 / (reach * reach);
    return {c[2] * scale, scatter * std::sqrt(inverse(2, 2)) * scale};
}

bool is_flat(std::span<const PositionSample> samples) {
    const double y = samples.front().p_lab.y();
    return std::all_of(samples.begin(), samples.end(), [&](const auto& s) {
        return s.p_lab.y() == y;
    });
}

}  // namespace kinectlab
