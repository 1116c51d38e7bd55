#include "server/experiments/definition.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "pipeline/analysis/analysis.hpp"
#include "pipeline/core/nearest_name.hpp"

namespace kinectlab::experiments {
namespace {

// Shortest text that gives the same number again: 0.1, not 0.100000.
std::string to_text(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

const Parameter* find(const Definition& definition, const std::string& name) {
    const auto& all = definition.parameters;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
    return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(const Definition& definition, RigKind rig) {
    std::vector<std::string> names;
    for (const auto& parameter : definition.parameters) {
        if (rig == RigKind::simulated || !parameter.simulation_only)
            names.push_back(parameter.name);
    }
    return names;
}

std::string range_of(const Parameter& parameter) {
    std::string text =
        "give a number from " + to_text(parameter.min) + " to " + to_text(parameter.max);
    if (parameter.unit != "1") text += " (" + parameter.unit + ")";
    return text;
}

std::optional<double> default_of(const Parameter& parameter, RigKind rig) {
    if (rig == RigKind::simulated && parameter.simulated_default)
        return parameter.simulated_default;
    return parameter.default_value;
}

/// Whether the analysis can do nothing without this parameter.
bool is_required(const Definition& definition, const std::string& parameter) {
    const auto method = analysis_method(definition.analysis.method);
    if (!method) return false;
    const auto feeds = [&](const AnalysisSetting& setting) {
        const auto source = definition.analysis.settings.find(setting.name);
        return setting.required && source != definition.analysis.settings.end() &&
               source->second.setting.parameter == parameter;
    };
    return std::any_of((*method)->settings.begin(), (*method)->settings.end(), feeds);
}

}  // namespace

Result<Values> validate(const Definition& definition, const Values& given, RigKind rig) {
    const auto wrong = [](const std::string& name, std::string message, std::string cure) {
        return fail(ErrorCode::invalid_argument, name, std::move(message), std::move(cure));
    };
    for (const auto& [name, value] : given) {
        const Parameter* parameter = find(definition, name);
        if (parameter == nullptr) {
            return wrong(
                name,
                "is not a parameter of " + definition.id,
                did_you_mean(name, names_of(definition, rig))
            );
        }
        if (rig != RigKind::simulated && parameter->simulation_only) {
            return wrong(name, "can only be set in a simulation", "leave it out");
        }
        const bool any = rig == RigKind::elsewhere && parameter->min >= 0.0;
        const double least = any ? 0.0 : parameter->min;
        const double most = any ? std::numeric_limits<double>::max() : parameter->max;
        const bool inside = value >= least && value <= most;  // false for NaN
        if (!inside)
            return wrong(
                name,
                "is " + to_text(value),
                any ? "give a number that is not negative" : range_of(*parameter)
            );
    }
    Values values;
    for (const auto& name : names_of(definition, rig)) {
        const auto found = given.find(name);
        if (found != given.end())
            values[name] = found->second;
        else if (const auto otherwise = default_of(*find(definition, name), rig);
                 otherwise && (rig != RigKind::elsewhere || is_required(definition, name)))
            values[name] = *otherwise;
    }
    return values;
}

std::optional<double> value_of(const Setting& setting, const Values& values) {
    if (!setting.parameter) return setting.number;
    const auto found = values.find(*setting.parameter);
    return found == values.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace kinectlab::experiments
