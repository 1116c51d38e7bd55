#include "server/experiments/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

const Trajectory* find(const std::vector<Trajectory>& all, const std::string& object) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& t) { return t.object == object; });
    return found == all.end() ? nullptr : &*found;
}

bool is_tracked(const MotionSample& sample) {
    return sample.status == TrackStatus::tracked;
}

Result<Trajectory> trajectory_of(const std::vector<Trajectory>& all, const std::string& object) {
    const Trajectory* found = find(all, object);
    if (found != nullptr && std::any_of(found->samples.begin(), found->samples.end(), is_tracked))
        return *found;
    return fail(
        ErrorCode::bad_data,
        object,
        "was never seen",
        "see that it is in the picture, and that the scene is learned without it"
    );
}

struct Tilt {
    double deg = 0.0;
    double u_deg = 0.0;
};

/// Between an object's own z, a plane's normal, and the vertical; the mean over all frames.
Result<Tilt> tilt_of(const std::vector<Trajectory>& all, const std::string& object) {
    const auto trajectory = trajectory_of(all, object);
    if (!trajectory) return tl::unexpected(trajectory.error());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double variance = 0.0;
    double n = 0.0;
    for (const auto& sample : trajectory->samples) {
        if (!is_tracked(sample) || !sample.has_orientation) continue;
        Eigen::Vector3d normal = sample.q_lab_obj * Eigen::Vector3d::UnitZ();
        if (normal.z() < 0.0) normal = -normal;
        sum += normal;
        variance += sample.covariance.diagonal().tail<3>().mean();
        n += 1.0;
    }
    if (n == 0.0)
        return fail(
            ErrorCode::bad_data, object, "was seen without its orientation", "track it as a plane"
        );
    constexpr double kDegree = std::numbers::pi / 180.0;
    const double angle = std::acos(std::clamp(sum.normalized().z(), -1.0, 1.0));
    // The camera's fixed pattern is the same in every frame: averaging does not take it away.
    return Tilt{angle / kDegree, std::sqrt(variance / n) / kDegree};
}

Result<AnalysisSettings> settings_of(const Seen& seen) {
    AnalysisSettings settings;
    for (const auto& [name, source] : seen.definition.analysis.settings) {
        if (source.tilt_of || source.tilt_u_of) {
            const auto tilt =
                tilt_of(seen.trajectories, source.tilt_of.value_or(source.tilt_u_of.value_or("")));
            if (!tilt) return tl::unexpected(tilt.error());
            settings[name] = source.tilt_of ? tilt->deg : tilt->u_deg;
        } else if (const auto value = value_of(source.setting, seen.values)) {
            settings[name] = *value;
        }
    }
    for (const auto& [name, value] : seen.overrides) {
        settings.erase(name);
        if (value) settings[name] = *value;
    }
    return settings;
}

std::map<std::string, double> facts_of(
    const AnalysisOutcome& outcome, const std::vector<Trajectory>& objects
) {
    auto facts = outcome.facts;
    double seen = 0.0;
    double frames = 0.0;
    double used = 0.0;
    double outliers = 0.0;
    double chi2 = 0.0;
    double seconds = 0.0;
    for (const auto& object : objects) {
        const auto& samples = object.samples;
        seen += static_cast<double>(std::count_if(samples.begin(), samples.end(), is_tracked));
        frames += static_cast<double>(samples.size());
        seconds = std::max(seconds, to_seconds(samples.back().t - samples.front().t));
    }
    for (const auto& fit : outcome.fits) {
        used += fit.used;
        outliers += fit.outliers;
        chi2 = std::max(chi2, fit.reduced_chi2);
    }
    facts["duration_s"] = seconds;
    facts["tracked_share"] = seen / frames;
    facts["outlier_share"] = outliers / std::max(used + outliers, 1.0);
    facts["reduced_chi2"] = chi2;
    return facts;
}

/// A check on what the run does not tell counts as missed: nobody can say that it is good.
json acceptance_json(
    const Definition& definition,
    const std::map<std::string, double>& facts,
    const std::vector<Measurement>& measurements,
    bool& accepted
) {
    json list = json::array();
    accepted = true;
    for (const auto& check : definition.acceptance) {
        std::optional<double> value;
        if (const auto fact = facts.find(check.fact); fact != facts.end()) value = fact->second;
        for (const auto& m : measurements)
            if (m.name == check.fact) value = m.value;
        const bool ok =
            value && (!check.min || *value >= *check.min) && (!check.max || *value <= *check.max);
        accepted = accepted && ok;
        json element = {
            {"fact", check.fact},
            {"value", value ? json(*value) : json()},
            {"ok", ok},
            {"reason", check.reason}};
        if (check.min) element["min"] = *check.min;
        if (check.max) element["max"] = *check.max;
        list.push_back(std::move(element));
    }
    return list;
}

/// {"x": […], "y": […], "z": […]}; NaN becomes null.
json columns(const std::vector<Eigen::Vector3d>& points) {
    json axes = {{"x", json::array()}, {"y", json::array()}, {"z", json::array()}};
    for (const Eigen::Vector3d& point : points) {
        axes["x"].push_back(point.x());
        axes["y"].push_back(point.y());
        axes["z"].push_back(point.z());
    }
    return axes;
}

json fit_json(const AnalysisOutcome& outcome, TimeNs zero) {
    json objects = json::array();
    for (const auto& fit : outcome.fits) {
        json t_s = json::array();
        for (const TimeNs t : fit.t)
            t_s.push_back(to_seconds(t - zero));
        objects.push_back(
            {{"object", fit.object},
             {"t_s", std::move(t_s)},
             {"measured", columns(fit.p_lab)},
             {"fit", columns(fit.fit_lab)},
             {"residual", columns(fit.residual)},
             {"used", fit.used},
             {"outliers", fit.outliers},
             {"reduced_chi2", fit.reduced_chi2}}
        );
    }
    return {{"objects", std::move(objects)}};
}

json plots_json(const AnalysisOutcome& outcome, const std::vector<std::string>& chosen) {
    json plots = json::array();
    for (const auto& name : chosen) {
        const auto found =
            std::find_if(outcome.plots.begin(), outcome.plots.end(), [&](const auto& p) {
                return p.name == name;
            });
        if (found == outcome.plots.end()) continue;
        json series = json::array();
        for (const auto& s : found->series) {
            json one = {
                {"name", s.name},
                {"mark", s.mark == PlotMark::line ? "line" : "points"},
                {"x", s.x},
                {"y", s.y}};
            if (!s.u.empty()) one["u"] = s.u;
            series.push_back(std::move(one));
        }
        plots.push_back(
            {{"name", found->name},
             {"title", found->title},
             {"x_label", found->x_label},
             {"y_label", found->y_label},
             {"equal_axes", found->equal_axes},
             {"series", std::move(series)}}
        );
    }
    return plots;
}

}  // namespace

Result<Evaluation> evaluate(const Seen& seen, Provenance provenance, TimeNs zero) {
    const Definition& definition = seen.definition;
    std::vector<Trajectory> objects;
    for (const auto& name : definition.analysis.objects) {
        auto trajectory = trajectory_of(seen.trajectories, name);
        if (!trajectory) return tl::unexpected(trajectory.error());
        objects.push_back(std::move(*trajectory));
    }
    const auto settings = settings_of(seen);
    if (!settings) return tl::unexpected(settings.error());
    auto outcome = analyse(definition.analysis.method, objects, *settings, seen.conditions);
    if (!outcome) return tl::unexpected(outcome.error());

    const auto facts = facts_of(*outcome, objects);
    for (const auto& fit : outcome->fits) {
        provenance.samples_used += static_cast<std::size_t>(fit.used);
        provenance.outliers += static_cast<std::size_t>(fit.outliers);
    }
    provenance.reduced_chi2 = facts.at("reduced_chi2");
    bool accepted = true;
    json acceptance = acceptance_json(definition, facts, outcome->measurements, accepted);

    Evaluation evaluation;
    evaluation.result = result_to_json(
        definition.id, seen.values, outcome->measurements, outcome->warnings, provenance
    );
    evaluation.result["analysis"] = {
        {"method", definition.analysis.method},
        {"objects", definition.analysis.objects},
        {"settings", *settings}};
    evaluation.result["facts"] = facts;
    evaluation.result["acceptance"] = std::move(acceptance);
    evaluation.result["accepted"] = accepted;
    evaluation.result["notes"] = outcome->notes;
    evaluation.fit = fit_json(*outcome, zero);
    evaluation.plots = plots_json(*outcome, definition.plots);
    evaluation.outcome = std::move(*outcome);
    return evaluation;
}

}  // namespace kinectlab::experiments
