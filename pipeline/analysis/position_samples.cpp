#include "pipeline/analysis/position_samples.hpp"

#include <Eigen/Cholesky>

namespace kinectlab {
namespace {

constexpr double kDefaultSigma = 1e-3;

}  // namespace

Result<std::vector<PositionSample>> collect_position_samples(
    const Trajectory& trajectory, std::size_t fewest
) {
    const auto& all = trajectory.samples;
    std::vector<PositionSample> samples;
    samples.reserve(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i > 0 && all[i].t <= all[i - 1].t)
            return fail(
                ErrorCode::bad_data,
                "t",
                "sample " + std::to_string(i) + " is not later than the one before it",
                "give samples in strictly increasing time"
            );
        if (all[i].status != TrackStatus::tracked) continue;
        const Eigen::Matrix3d covariance = all[i].covariance.topLeftCorner<3, 3>();
        if (!all[i].p_lab.allFinite() || !covariance.allFinite())
            return fail(
                ErrorCode::bad_data,
                "p_lab",
                "sample " + std::to_string(i) + " is marked tracked but is not a number",
                "mark it lost, or give its position and covariance"
            );
        PositionSample sample{
            i,
            to_seconds(all[i].t - all.front().t),
            all[i].p_lab,
            Eigen::Matrix3d::Identity() / kDefaultSigma,
            Eigen::Vector3d::Constant(kDefaultSigma)};
        const Eigen::LLT<Eigen::Matrix3d> cholesky(covariance);
        if (cholesky.info() == Eigen::Success && covariance.diagonal().minCoeff() > 0.0) {
            sample.whiten = cholesky.matrixL().solve(Eigen::Matrix3d::Identity());
            sample.sigma = covariance.diagonal().cwiseSqrt();
        }
        samples.push_back(sample);
    }
    if (samples.size() < fewest)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "the object was seen in " + std::to_string(samples.size()) + " of " +
                std::to_string(all.size()) + " frames",
            "at least " + std::to_string(fewest) + " are needed"
        );
    return samples;
}

}  // namespace kinectlab
