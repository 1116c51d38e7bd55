#include <algorithm>

#include <nlohmann/json.hpp>

#include "pipeline/core/nearest_name.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/model_files.hpp"
#include "server/experiments/objects_json.hpp"
#include "server/experiments/preprocess_json.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

Result<Parameter> read_parameter(const json& element, const std::string& path) {
    ObjectReader reader(
        element, path, {"name", "unit", "min", "max", "step", "default", "help", "simulation_only"}
    );
    Parameter parameter;
    parameter.name = reader.text("name");
    parameter.unit = reader.text("unit");
    parameter.min = reader.number("min");
    parameter.max = reader.number("max");
    parameter.step = reader.number("step");
    parameter.default_value = reader.number("default");
    parameter.help = reader.text("help");
    parameter.simulation_only = reader.flag_or("simulation_only", false);
    if (!(parameter.min < parameter.max))
        reader.refuse("min", "is not below max", "give min < max");
    if (!(parameter.step > 0.0)) reader.refuse("step", "is not above 0", "give a positive step");
    if (parameter.default_value < parameter.min || parameter.default_value > parameter.max) {
        reader.refuse("default", "lies outside min and max", "give a default between them");
    }
    if (!reader.ok()) return reader.error();
    return parameter;
}

/// The element with every {"parameter": NAME} replaced by that parameter's value.
Result<json> with_values(json element, const std::string& path, const Values& values) {
    for (auto& [key, setting] : element.items()) {
        if (!setting.is_object() || !setting.contains("parameter")) continue;
        ObjectReader reader(setting, path + "." + key, {"parameter"});
        const auto name = reader.text("parameter");
        const auto value = values.find(name);
        if (reader.ok() && value == values.end())
            reader.refuse("parameter", "is \"" + name + "\"", "name one of the parameters");
        if (!reader.ok()) return reader.error();
        setting = value->second;
    }
    return element;
}

Result<ObjectSpec> resolve(const json& element, const std::string& path, const Values& values) {
    if (!element.is_object()) return read_object(element, path);
    return with_values(element, path, values).and_then([&](const json& resolved) {
        return read_object(resolved, path);
    });
}

/// Right for every value that a parameter can take if it is for the least and the greatest.
Result<ExperimentObject> read_experiment_object(
    const json& element, const std::string& path, const std::vector<Parameter>& parameters
) {
    for (const auto end : {&Parameter::default_value, &Parameter::min, &Parameter::max}) {
        Values values;
        for (const auto& parameter : parameters)
            values[parameter.name] = parameter.*end;
        if (auto spec = resolve(element, path, values); !spec)
            return tl::unexpected<Error>(spec.error());
    }
    return ExperimentObject{element.dump()};
}

Result<Definition> load_file(const std::filesystem::path& file) {
    const auto beside = [&](json document) {
        return with_models_beside(file, std::move(document));
    };
    return read_json_file(file).map(beside).and_then(read_definition).map_error([&](Error error) {
        if (error.field != file.string()) error.field = file.string() + ": " + error.field;
        return error;
    });
}

}  // namespace

Result<Definition> read_definition(const json& document) {
    ObjectReader reader(
        document, "", {"id", "title", "summary", "parameters", "objects", "preprocess"}
    );
    Definition definition;
    definition.id = reader.text("id");
    definition.title = reader.text("title");
    definition.summary = reader.text("summary");
    const auto& parameters = reader.array("parameters");
    const auto& objects = reader.array("objects");
    if (!reader.ok()) return reader.error();

    for (std::size_t i = 0; i < parameters.size(); ++i) {
        auto parameter = read_parameter(parameters[i], "parameters[" + std::to_string(i) + "]");
        if (!parameter) return tl::unexpected<Error>(parameter.error());
        definition.parameters.push_back(std::move(*parameter));
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
        auto object = read_experiment_object(
            objects[i], "objects[" + std::to_string(i) + "]", definition.parameters
        );
        if (!object) return tl::unexpected<Error>(object.error());
        definition.objects.push_back(std::move(*object));
    }
    if (reader.has("preprocess")) {
        auto preprocess = read_preprocess(document["preprocess"], "preprocess");
        if (!preprocess) return tl::unexpected<Error>(preprocess.error());
        definition.preprocess = *preprocess;
    }
    return definition;
}

json to_json(const Definition& definition) {
    json parameters = json::array();
    for (const auto& p : definition.parameters) {
        parameters.push_back(
            {{"name", p.name},
             {"unit", p.unit},
             {"min", p.min},
             {"max", p.max},
             {"step", p.step},
             {"default", p.default_value},
             {"help", p.help},
             {"simulation_only", p.simulation_only}}
        );
    }
    json objects = json::array();
    for (const auto& object : definition.objects)
        objects.push_back(json::parse(object.json));
    json document = {
        {"id", definition.id},
        {"title", definition.title},
        {"summary", definition.summary},
        {"parameters", std::move(parameters)},
        {"objects", std::move(objects)}};
    if (definition.preprocess) document["preprocess"] = to_json(*definition.preprocess);
    return document;
}

TrackingPlan plan_for(const Definition& definition, const Values& values) {
    TrackingPlan plan;
    plan.preprocess = definition.preprocess.value_or(PreprocessSettings{});
    for (std::size_t i = 0; i < definition.objects.size(); ++i) {
        auto spec = resolve(
            json::parse(definition.objects[i].json), "objects[" + std::to_string(i) + "]", values
        );
        plan.objects.push_back(std::move(spec.value()));
    }
    return plan;
}

Result<std::vector<Definition>> load_definitions(const std::filesystem::path& folder) {
    std::error_code code;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, code)) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    if (code || files.empty()) {
        return fail(
            ErrorCode::not_found,
            folder.string(),
            "has no experiments (*.json)",
            "install the program together with its share folder"
        );
    }
    std::sort(files.begin(), files.end());
    std::vector<Definition> definitions;
    for (const auto& file : files) {
        auto definition = load_file(file);
        if (!definition) return tl::unexpected<Error>(definition.error());
        if (definition->id != file.stem()) {
            return fail(
                ErrorCode::bad_data,
                file.string() + ": id",
                "is \"" + definition->id + "\"",
                "give the file's own name, " + file.stem().string()
            );
        }
        definitions.push_back(std::move(*definition));
    }
    return definitions;
}

Result<Definition> load_definition(const std::filesystem::path& folder, const std::string& id) {
    auto all = load_definitions(folder);
    if (!all) return tl::unexpected<Error>(all.error());
    std::vector<std::string> ids;
    for (auto& definition : *all) {
        if (definition.id == id) return std::move(definition);
        ids.push_back(definition.id);
    }
    return fail(
        ErrorCode::not_found, "experiment", "\"" + id + "\" is not known", did_you_mean(id, ids)
    );
}

}  // namespace kinectlab::experiments
