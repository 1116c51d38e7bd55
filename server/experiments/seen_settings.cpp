#include "server/experiments/seen_settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

namespace kinectlab::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLevel = 1e-6;  // sine of a tilt that has no direction

double angle_to_vertical(const Eigen::Vector3d& normal) {
    return std::atan2(normal.head<2>().norm(), normal.z());
}

/// The one turn of a plane that changes its tilt. It is at right angles to the normal, about which
/// the plane may be turned anyhow: that is no part of the tilt's uncertainty.
Eigen::Vector3d axis_of_tilt(const Eigen::Vector3d& normal) {
    const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ().cross(normal);
    return axis.norm() > kLevel ? axis.normalized() : normal.unitOrthogonal();
}

/// Whether a number must be had for the analysis to run at all.
bool is_required(const std::string& method, const std::string& setting) {
    const auto found = analysis_method(method);
    if (!found) return false;
    const auto& all = (*found)->settings;
    return std::any_of(all.begin(), all.end(), [&](const AnalysisSetting& one) {
        return one.name == setting && one.required;
    });
}

}  // namespace

Result<PlaneTilt> tilt_of(
    const std::vector<Trajectory>& all, const std::string& object, double level_u_rad
) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& t) { return t.object == object; });
    std::vector<double> tilts;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double claimed = 0.0;
    for (const auto& sample : found == all.end() ? std::vector<MotionSample>{} : found->samples) {
        if (sample.status != TrackStatus::tracked || !sample.has_orientation) continue;
        Eigen::Vector3d normal = sample.q_lab_obj * Eigen::Vector3d::UnitZ();
        if (normal.z() < 0.0) normal = -normal;
        sum += normal;
        tilts.push_back(angle_to_vertical(normal));
        const Eigen::Vector3d axis = axis_of_tilt(normal);
        claimed += axis.dot(sample.covariance.bottomRightCorner<3, 3>() * axis);
    }
    if (tilts.empty())
        return fail(
            ErrorCode::bad_data,
            object,
            "was not seen as a plane",
            "see that it is in the picture, and that its object is of the method plane"
        );
    const auto n = static_cast<double>(tilts.size());
    const double tilt = angle_to_vertical(sum.normalized());
    double scatter = 0.0;
    for (const double one : tilts)
        scatter += (one - tilt) * (one - tilt);
    const double variance = std::max(claimed, scatter) / n;
    return PlaneTilt{tilt / kDegree, std::hypot(std::sqrt(variance), level_u_rad) / kDegree};
}

Result<SeenSettings> settings_of(const Seen& seen) {
    SeenSettings settings;
    std::set<std::string> unseen;
    const AnalysisChoice& analysis = seen.definition.analysis;
    for (const auto& [name, source] : analysis.settings) {
        if (seen.overrides.contains(name)) continue;
        if (source.tilt_of || source.tilt_u_of) {
            const std::string& object = source.tilt_of ? *source.tilt_of : *source.tilt_u_of;
            const auto tilt = tilt_of(seen.trajectories, object, seen.conditions.tilt_u_rad);
            if (!tilt && is_required(analysis.method, name)) return tl::unexpected(tilt.error());
            if (tilt)
                settings.values[name] = source.tilt_of ? tilt->deg : tilt->u_deg;
            else if (unseen.insert(object).second)
                settings.warnings.push_back(fmt::format(
                    "The {} was not seen as a plane, so its angle is not in these results.", object
                ));
        } else if (const auto value = value_of(source.setting, seen.values)) {
            settings.values[name] = *value;
        }
    }
    for (const auto& [name, value] : seen.overrides)
        if (value) settings.values[name] = *value;
    return settings;
}

}  // namespace kinectlab::experiments
