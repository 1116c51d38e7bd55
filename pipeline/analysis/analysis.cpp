#include "pipeline/analysis/analysis.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/core/nearest_name.hpp"

namespace kinectlab {
namespace {

bool shows_orientation(const Trajectory& trajectory) {
    const auto& all = trajectory.samples;
    return std::any_of(all.begin(), all.end(), [](const auto& s) { return s.has_orientation; });
}

}  // namespace

Result<const AnalysisMethod*> analysis_method(const std::string& name) {
    std::vector<std::string> names;
    for (const auto& method : analysis_methods()) {
        if (method.name == name) return &method;
        names.push_back(method.name);
    }
    return fail(
        ErrorCode::not_found,
        "method",
        fmt::format("\"{:.64}\" is no analysis", name),
        did_you_mean(name, names)
    );
}

Result<AnalysisSettings> check_settings(
    const AnalysisMethod& method, const AnalysisSettings& given
) {
    std::vector<std::string> names;
    for (const auto& setting : method.settings)
        names.push_back(setting.name);
    for (const auto& [name, value] : given) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        return fail(
            ErrorCode::invalid_argument,
            name,
            "is no setting of the analysis " + method.name,
            names.empty() ? "it has none" : did_you_mean(name, names)
        );
    }
    AnalysisSettings settings = given;
    for (const auto& setting : method.settings) {
        const auto found = given.find(setting.name);
        if (found == given.end()) {
            if (setting.required)
                return fail(
                    ErrorCode::invalid_argument,
                    setting.name,
                    "is missing",
                    fmt::format("give a number from {} to {}", setting.min, setting.max)
                );
            if (setting.otherwise) settings[setting.name] = *setting.otherwise;
            continue;
        }
        const bool inside = found->second >= setting.min && found->second <= setting.max;
        if (!inside)  // also NaN
            return fail(
                ErrorCode::invalid_argument,
                setting.name,
                fmt::format("is {}", found->second),
                fmt::format("give a number from {} to {}", setting.min, setting.max)
            );
    }
    return settings;
}

Result<AnalysisOutcome> analyse(
    const std::string& name,
    std::span<const Trajectory> objects,
    const AnalysisSettings& given,
    const AnalysisConditions& conditions
) {
    const auto method = analysis_method(name);
    if (!method) return tl::unexpected(method.error());
    const auto settings = check_settings(**method, given);
    if (!settings) return tl::unexpected(settings.error());
    if (objects.size() != static_cast<std::size_t>((*method)->objects))
        return fail(
            ErrorCode::invalid_argument,
            "objects",
            fmt::format(
                "are {}, and the analysis {} takes {}", objects.size(), name, (*method)->objects
            ),
            "track as many objects as it takes"
        );
    for (const auto& object : objects) {
        if (!(*method)->needs_orientation || shows_orientation(object)) continue;
        return fail(
            ErrorCode::bad_data,
            object.object,
            "was seen without its orientation, which the analysis " + name + " needs",
            "track it by a method that gives six degrees of freedom"
        );
    }
    return (*method)->run(objects, *settings, conditions);
}

}  // namespace kinectlab
