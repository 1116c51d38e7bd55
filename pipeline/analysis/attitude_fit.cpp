#include "pipeline/analysis/attitude_fit.hpp"

namespace kinectlab {

Result<ResidualFit> fit_attitudes(
    std::span<const AttitudeSample> samples,
    const AttitudeModel& model,
    std::span<const PathParameter> parameters,
    bool alike
) {
    std::vector<ResidualPlace> places;
    std::vector<double> t;
    for (const auto& s : samples) {
        places.push_back({0, s.t});
        t.push_back(s.t);
    }
    std::vector<Eigen::Quaterniond> fitted(samples.size());
    const ResidualModel residuals = [&](const Eigen::VectorXd& p, std::span<Eigen::Vector3d> r) {
        model(p, t, fitted);
        for (std::size_t i = 0; i < r.size(); ++i) {
            const auto& s = samples[i];
            const Eigen::Quaterniond q =
                alike ? nearest_alike(s.q_lab_obj, fitted[i]) : s.q_lab_obj;
            r[i] = s.whiten * turn_between(fitted[i], q);
        }
    };
    return fit_residuals(places, residuals, parameters);
}

}  // namespace kinectlab
