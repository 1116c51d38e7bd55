#include "server/experiments/definition_names.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/core/nearest_name.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

std::vector<std::string> parameter_names(const Definition& definition) {
    std::vector<std::string> names;
    for (const auto& p : definition.parameters)
        names.push_back(p.name);
    return names;
}

}  // namespace

std::string element_of(const char* list, std::size_t i) {
    return fmt::format("{}[{}]", list, i);
}

std::vector<std::string> object_names(const Definition& definition) {
    std::vector<std::string> names;
    for (const auto& object : definition.objects)
        names.push_back(json::parse(object.json).value("name", ""));
    return names;
}

bool among(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

tl::unexpected<Error> not_among(
    const std::string& path, const std::string& name, const std::vector<std::string>& names
) {
    return fail(
        ErrorCode::invalid_argument,
        path,
        "is \"" + name.substr(0, 64) + "\"",
        names.empty() ? "leave it out" : did_you_mean(name, names)
    );
}

/// A number, or {"parameter": NAME}.
Result<Setting> read_setting(
    const json& value, const std::string& path, const Definition& definition
) {
    if (value.is_number()) return Setting{std::nullopt, value.get<double>()};
    ObjectReader reader(value, path, {"parameter"});
    const std::string name = reader.text("parameter");
    if (!reader.ok()) return reader.error();
    const auto names = parameter_names(definition);
    if (!among(names, name)) return not_among(path + ".parameter", name, names);
    return Setting{name, 0.0};
}

json setting_json(const Setting& setting) {
    return setting.parameter ? json{{"parameter", *setting.parameter}} : json(setting.number);
}

}  // namespace kinectlab::experiments
