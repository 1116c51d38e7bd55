#include "pipeline/track/rigid_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace kinectlab {
namespace {

constexpr double kMissChance = 1e-3;
constexpr int kRounds = 12;
constexpr double kSettled = 1e-9;  // m and rad

/// A small generator, so that the same pairs always give the same pose.
class Draw {
public:
    std::size_t below(std::size_t n) {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<std::size_t>((state_ >> 33U) % n);
    }

private:
    std::uint64_t state_ = 0x853c49e6748fea9bULL;
};

using Three = std::array<std::size_t, 3>;

/// Three spots keep their distances when they move together; cheap to ask before anything else.
bool keeps_distances(std::span<const PointPair> pairs, const Three& three, double gate) {
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
        const auto& a = pairs[three[static_cast<std::size_t>(k)]];
        const auto& b = pairs[three[static_cast<std::size_t>((k + 1) % 3)]];
        const double obj = (a.p_obj - b.p_obj).norm(), cam = (a.p_cam - b.p_cam).norm();
        const double sigma = std::sqrt((a.covariance.trace() + b.covariance.trace()) / 3.0);
        if (!(std::abs(obj - cam) <= gate * sigma) || obj < 4.0 * sigma) return false;
        longest = std::max(longest, obj);
    }
    // Far enough from a line: the triangle's height over its longest side.
    const Eigen::Vector3d ab = pairs[three[1]].p_obj - pairs[three[0]].p_obj;
    const Eigen::Vector3d ac = pairs[three[2]].p_obj - pairs[three[0]].p_obj;
    return ab.cross(ac).norm() > 0.1 * longest * longest;
}

Eigen::Isometry3d through(std::span<const PointPair> pairs, const Three& three) {
    Eigen::Matrix3d obj, cam;
    for (int k = 0; k < 3; ++k) {
        obj.col(k) = pairs[three[static_cast<std::size_t>(k)]].p_obj;
        cam.col(k) = pairs[three[static_cast<std::size_t>(k)]].p_cam;
    }
    Eigen::Isometry3d T;
    T.matrix() = Eigen::umeyama(obj, cam, false);
    return T;
}

class PairSet {
public:
    explicit PairSet(std::span<const PointPair> pairs) : pairs_(pairs) {
        information_.reserve(pairs.size());
        for (const auto& pair : pairs)
            information_.push_back(pair.covariance.inverse());
    }

    [[nodiscard]] double square_sigmas(const Eigen::Isometry3d& T, std::size_t i) const {
        const Eigen::Vector3d residual = pairs_[i].p_cam - T * pairs_[i].p_obj;
        return residual.dot(information_[i] * residual);
    }

    [[nodiscard]] int count(const Eigen::Isometry3d& T, double gate) const {
        int inliers = 0;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            inliers += square_sigmas(T, i) <= gate * gate ? 1 : 0;
        return inliers;
    }

    /// One Gauss-Newton step; the information matrix is left for the covariance.
    [[nodiscard]] Eigen::Matrix<double, 6, 1> step(
        const Eigen::Isometry3d& T, double gate, Matrix6d& information
    ) const {
        information.setZero();
        Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            const double off2 = square_sigmas(T, i) / (gate * gate);
            if (!(off2 < 1.0)) continue;
            const double weight = (1.0 - off2) * (1.0 - off2);
            const Eigen::Vector3d arm = T.linear() * pairs_[i].p_obj;
            Eigen::Matrix<double, 3, 6> J;
            J.leftCols<3>().setIdentity();
            J.rightCols<3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
            const Eigen::Matrix<double, 6, 3> JW = weight * J.transpose() * information_[i];
            information += JW * J;
            gradient += JW * (pairs_[i].p_cam - T * pairs_[i].p_obj);
        }
        return information.ldlt().solve(gradient);
    }

private:
    std::span<const PointPair> pairs_;
    std::vector<Eigen::Matrix3d> information_;
};

std::optional<Eigen::Isometry3d> consensus(
    std::span<const PointPair> pairs, const PairSet& set, const RigidFitSettings& settings
) {
    Draw draw;
    std::optional<Eigen::Isometry3d> best;
    int most = 2;
    double draws_needed = settings.most_draws;
    for (int i = 0; i < settings.most_draws && i < draws_needed; ++i) {
        const Three three{
            draw.below(pairs.size()), draw.below(pairs.size()), draw.below(pairs.size())};
        if (three[0] == three[1] || three[1] == three[2] || three[0] == three[2]) continue;
        if (!keeps_distances(pairs, three, settings.gate_sigmas)) continue;
        const Eigen::Isometry3d T = through(pairs, three);
        const int inliers = set.count(T, settings.gate_sigmas);
        if (inliers <= most) continue;
        most = inliers;
        best = T;
        const double share = static_cast<double>(inliers) / static_cast<double>(pairs.size());
        draws_needed = std::log(kMissChance) / std::log1p(-std::min(0.999, std::pow(share, 3)));
    }
    return best;
}

}  // namespace

std::optional<RigidFit> fit_rigid(
    std::span<const PointPair> pairs, const RigidFitSettings& settings
) {
    if (static_cast<int>(pairs.size()) < std::max(3, settings.fewest_inliers)) return std::nullopt;
    const PairSet set(pairs);
    const auto start = consensus(pairs, set, settings);
    if (!start) return std::nullopt;

    RigidFit fit;
    fit.T_cam_obj = *start;
    Matrix6d information = Matrix6d::Zero();
    for (int round = 0; round < kRounds; ++round) {
        const Eigen::Matrix<double, 6, 1> step =
            set.step(fit.T_cam_obj, 1.5 * settings.gate_sigmas, information);
        if (!step.allFinite()) return std::nullopt;
        fit.T_cam_obj.translation() += step.head<3>();
        const double angle = step.tail<3>().norm();
        if (angle > 0.0)
            fit.T_cam_obj.linear() =
                Eigen::AngleAxisd(angle, step.tail<3>() / angle) * fit.T_cam_obj.linear();
        if (step.cwiseAbs().maxCoeff() < kSettled) break;
    }
    fit.T_cam_obj.linear() = Eigen::Quaterniond(fit.T_cam_obj.linear()).normalized().matrix();

    double squares = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double square = set.square_sigmas(fit.T_cam_obj, i);
        if (square > settings.gate_sigmas * settings.gate_sigmas) continue;
        squares += square;
        fit.inlier_pairs.push_back(static_cast<std::uint32_t>(i));
    }
    fit.inliers = static_cast<int>(fit.inlier_pairs.size());
    if (fit.inliers < settings.fewest_inliers ||
        fit.inliers < settings.fewest_share * static_cast<double>(pairs.size()))
        return std::nullopt;
    const double reduced_chi2 = squares / std::max(1.0, 3.0 * fit.inliers - 6.0);
    fit.rms_sigmas = std::sqrt(squares / (3.0 * fit.inliers));
    const Eigen::SelfAdjointEigenSolver<Matrix6d> spectrum(information);
    if (!(spectrum.eigenvalues()[0] > 0.0)) return std::nullopt;
    fit.covariance = std::max(1.0, reduced_chi2) * information.inverse();
    const double turn = fit.covariance.diagonal().tail<3>().maxCoeff();
    if (!(turn <= settings.most_turn_u * settings.most_turn_u)) return std::nullopt;
    return fit;
}

}  // namespace kinectlab
