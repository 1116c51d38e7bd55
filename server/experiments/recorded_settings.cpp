#include "server/experiments/recorded_settings.hpp"

#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

Result<Values> read_values(const Definition& definition, const nlohmann::json& document) {
    ObjectReader reader(document, "", {"experiment", "parameters", "released_ns"});
    const std::string id = reader.text("experiment");
    if (reader.ok() && id != definition.id)
        reader.refuse(
            "experiment", "is \"" + id + "\"", "give a recording of the experiment " + definition.id
        );
    if (!reader.ok()) return reader.error();

    std::vector<std::string> names;
    for (const auto& parameter : definition.parameters)
        names.push_back(parameter.name);
    static const nlohmann::json kNone = nlohmann::json::object();
    const auto& recorded = document.contains("parameters") ? document["parameters"] : kNone;
    ObjectReader parameters(recorded, "parameters", names);
    Values values;
    for (const auto& parameter : definition.parameters) {
        if (parameter.simulation_only || !parameters.has(parameter.name)) continue;
        // A recording may be shorter or longer than a person may ask of a rig.
        if (parameter.name == "duration_s") continue;
        values[parameter.name] = parameters.number(parameter.name);
    }
    if (!parameters.ok()) return parameters.error();
    return validate(definition, values, RigKind::real);
}

}  // namespace

Result<Values> with_recorded_settings(
    const Definition& definition, const Values& given, const std::filesystem::path& recording
) {
    const auto file = recording / "experiment.json";
    std::error_code code;
    Values values;
    if (std::filesystem::is_regular_file(file, code)) {
        const auto document = read_json_file(file);
        if (!document) return tl::unexpected(document.error());
        auto recorded = read_values(definition, *document);
        if (!recorded) {
            Error error = recorded.error();
            error.field = file.string() + (error.field.empty() ? "" : ": ") + error.field;
            error.code = ErrorCode::bad_data;
            return tl::unexpected(error);
        }
        values = std::move(*recorded);
    }
    for (const auto& [name, value] : given)
        values[name] = value;
    return validate(definition, values, RigKind::real);
}

Values recorded_truth(const Definition& definition, const std::filesystem::path& recording) {
    const auto file = recording / "experiment.json";
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code)) return {};
    const auto document = read_json_file(file);
    if (!document || !document->is_object() || !document->contains("parameters")) return {};
    const auto& recorded = (*document)["parameters"];
    Values values;
    for (const auto& parameter : definition.parameters) {
        const bool told = recorded.is_object() && recorded.contains(parameter.name) &&
                          recorded[parameter.name].is_number();
        if (parameter.simulation_only && told)
            values[parameter.name] = recorded[parameter.name].get<double>();
    }
    return values;
}

std::optional<TimeNs> recorded_release(const std::filesystem::path& recording) {
    const auto file = recording / "experiment.json";
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code)) return std::nullopt;
    const auto document = read_json_file(file);
    if (!document || !document->is_object() || !document->contains("released_ns")) return {};
    const auto& released = (*document)["released_ns"];
    return released.is_number_integer() ? std::optional(released.get<TimeNs>()) : std::nullopt;
}

}  // namespace kinectlab::experiments
