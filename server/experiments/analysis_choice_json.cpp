#include "server/experiments/analysis_choice_json.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/analysis/analysis.hpp"
#include "server/experiments/definition_names.hpp"
#include "server/experiments/strict_json.hpp"
#include "server/experiments/student_text.hpp"
#include "server/experiments/units_of_names.hpp"

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

/// A setting, or {"tilt_of": OBJECT} or {"tilt_u_of": OBJECT}.
Result<AnalysisSource> read_source(
    const json& value, const std::string& path, const Definition& definition
) {
    for (const char* key : {"tilt_of", "tilt_u_of"}) {
        if (!value.is_object() || !value.contains(key)) continue;
        ObjectReader reader(value, path, {key});
        const std::string object = reader.text(key);
        if (!reader.ok()) return reader.error();
        const auto names = object_names(definition);
        if (!among(names, object)) return not_among(path + "." + key, object, names);
        AnalysisSource source;
        (std::string_view(key) == "tilt_of" ? source.tilt_of : source.tilt_u_of) = object;
        return source;
    }
    auto setting = read_setting(value, path, definition);
    if (!setting) return tl::unexpected(setting.error());
    return AnalysisSource{std::move(*setting), {}, {}};
}

Result<void> check_bound_parameter(
    const AnalysisSetting& setting,
    const Setting& given,
    const std::string& path,
    const Definition& definition
) {
    if (!given.parameter) {
        if (given.number >= setting.min && given.number <= setting.max) return {};
        return fail(
            ErrorCode::invalid_argument,
            path,
            fmt::format("is {}", given.number),
            fmt::format("give a number from {} to {}", setting.min, setting.max)
        );
    }
    const auto& all = definition.parameters;
    const auto parameter = std::find_if(all.begin(), all.end(), [&](const auto& p) {
        return p.name == *given.parameter;
    });
    const auto wanted = unit_in_name(setting.name);
    if (!wanted.empty() && parameter->unit != wanted)
        return fail(
            ErrorCode::invalid_argument,
            path + ".parameter",
            "is in " + parameter->unit + ", and " + setting.name + " is in " + std::string(wanted),
            "name a parameter of that unit"
        );
    if (setting.required && !parameter->default_value)
        return fail(
            ErrorCode::invalid_argument,
            path + ".parameter",
            "has no default, and the analysis cannot do without " + setting.name,
            "give " + parameter->name + " a default"
        );
    return {};
}

Result<void> read_analysis(const json& document, Definition& definition) {
    if (!document.contains("analysis"))
        return fail(
            ErrorCode::invalid_argument,
            "analysis",
            "is missing",
            "name how the run becomes numbers, {\"method\": NAME}"
        );
    ObjectReader reader(document["analysis"], "analysis", {"method", "objects", "settings"});
    AnalysisChoice& choice = definition.analysis;
    choice.method = reader.text("method");
    const json& listed = reader.has("objects") ? reader.array("objects") : json();
    if (!reader.ok()) return reader.error();
    const auto method = analysis_method(choice.method);
    if (!method) {
        Error error = method.error();
        error.field = "analysis.method";
        error.code = ErrorCode::invalid_argument;
        return tl::unexpected(error);
    }
    const auto names = object_names(definition);
    choice.objects = names;
    if (!listed.is_null()) {
        choice.objects.clear();
        for (std::size_t i = 0; i < listed.size(); ++i) {
            const auto path = element_of("analysis.objects", i);
            const std::string name =
                listed[i].is_string() ? listed[i].get<std::string>() : listed[i].dump();
            if (!among(names, name)) return not_among(path, name, names);
            choice.objects.push_back(name);
        }
    }
    if (choice.objects.size() != static_cast<std::size_t>((*method)->objects))
        return fail(
            ErrorCode::invalid_argument,
            "analysis.objects",
            fmt::format(
                "are {}, and the analysis {} takes {}",
                choice.objects.size(),
                choice.method,
                (*method)->objects
            ),
            "list those that it is for"
        );
    const json none = json::object();
    const json& settings = reader.has("settings") ? document["analysis"]["settings"] : none;
    std::vector<std::string> known;
    for (const auto& setting : (*method)->settings)
        known.push_back(setting.name);
    ObjectReader keys(settings, "analysis.settings", known);
    if (!keys.ok()) return keys.error();
    for (const auto& setting : (*method)->settings) {
        const std::string path = "analysis.settings." + setting.name;
        if (!settings.contains(setting.name)) {
            if (!setting.required) continue;
            return fail(ErrorCode::invalid_argument, path, "is missing", setting.help);
        }
        auto source = read_source(settings[setting.name], path, definition);
        if (!source) return tl::unexpected(source.error());
        const bool plain = !source->tilt_of && !source->tilt_u_of;
        if (plain)
            if (auto ok = check_bound_parameter(setting, source->setting, path, definition); !ok)
                return ok;
        choice.settings[setting.name] = std::move(*source);
    }
    return {};
}

Result<void> read_plots(const json& document, Definition& definition) {
    const auto method = analysis_method(definition.analysis.method);
    const auto& offered = (*method)->plots;
    if (!document.contains("plots")) {
        definition.plots = offered;
        return {};
    }
    if (!document["plots"].is_array())
        return fail(ErrorCode::invalid_argument, "plots", "is no list", "give a list of names");
    for (std::size_t i = 0; i < document["plots"].size(); ++i) {
        const json& name = document["plots"][i];
        const std::string text = name.is_string() ? name.get<std::string>() : name.dump();
        if (!among(offered, text)) return not_among(element_of("plots", i), text, offered);
        definition.plots.push_back(text);
    }
    return {};
}

Result<void> read_acceptance(const json& document, Definition& definition) {
    if (!document.contains("acceptance")) return {};
    const json& checks = document["acceptance"];
    if (!checks.is_array())
        return fail(
            ErrorCode::invalid_argument, "acceptance", "is no list", "give a list of checks"
        );
    const auto method = analysis_method(definition.analysis.method);
    std::vector<std::string> known = (*method)->facts;
    known.insert(known.end(), (*method)->results.begin(), (*method)->results.end());
    known.insert(known.end(), kCommonFacts.begin(), kCommonFacts.end());
    for (std::size_t i = 0; i < checks.size(); ++i) {
        ObjectReader reader(
            checks[i], element_of("acceptance", i), {"fact", "min", "max", "reason"}
        );
        AcceptanceCheck check;
        check.fact = reader.text("fact");
        check.min = reader.optional_number("min");
        check.max = reader.optional_number("max");
        check.reason = reader.text("reason");
        if (!check.min && !check.max)
            reader.refuse("min", "and max are both missing", "give one of them");
        if (check.min && check.max && *check.min > *check.max)
            reader.refuse("min", "is above max, so that no run is good", "give min <= max");
        if (!reader.ok()) return reader.error();
        if (auto ok = check_student_text(check.reason, reader.path_of("reason")); !ok)
            return tl::unexpected(ok.error());
        if (!among(known, check.fact)) return not_among(reader.path_of("fact"), check.fact, known);
        definition.acceptance.push_back(std::move(check));
    }
    return {};
}

}  // namespace

Result<void> read_analysis_choice(const json& document, Definition& definition) {
    return read_analysis(document, definition)
        .and_then([&] { return read_plots(document, definition); })
        .and_then([&] { return read_acceptance(document, definition); });
}

void write_analysis_choice(const Definition& definition, json& document) {
    json settings = json::object();
    for (const auto& [name, source] : definition.analysis.settings) {
        if (source.tilt_of)
            settings[name] = {{"tilt_of", *source.tilt_of}};
        else if (source.tilt_u_of)
            settings[name] = {{"tilt_u_of", *source.tilt_u_of}};
        else
            settings[name] = setting_json(source.setting);
    }
    document["analysis"] = {
        {"method", definition.analysis.method},
        {"objects", definition.analysis.objects},
        {"settings", std::move(settings)}};
    document["plots"] = definition.plots;
    json& acceptance = document["acceptance"] = json::array();
    for (const auto& check : definition.acceptance) {
        json element = {{"fact", check.fact}, {"reason", check.reason}};
        if (check.min) element["min"] = *check.min;
        if (check.max) element["max"] = *check.max;
        acceptance.push_back(std::move(element));
    }
}

}  // namespace kinectlab::experiments
