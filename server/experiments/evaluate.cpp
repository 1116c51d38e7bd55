#include "server/experiments/evaluate.hpp"

#include <algorithm>

#include "server/experiments/seen_settings.hpp"

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
    facts.try_emplace("duration_s", seconds);  // of what was used, where the method tells it
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
    auto outcome = analyse(definition.analysis.method, objects, settings->values, seen.conditions);
    if (!outcome) return tl::unexpected(outcome.error());
    for (const auto& warning : settings->warnings)
        outcome->warnings.push_back(warning);

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
        {"settings", settings->values}};
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
