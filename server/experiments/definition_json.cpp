#include <algorithm>

#include <nlohmann/json.hpp>

#include "pipeline/core/nearest_name.hpp"
#include "pipeline/track/carrying_plane.hpp"
#include "server/experiments/apparatus_check.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/definition_parts_json.hpp"
#include "server/experiments/objects_json.hpp"
#include "server/experiments/preprocess_json.hpp"
#include "server/experiments/schema_check.hpp"
#include "server/experiments/strict_json.hpp"
#include "server/experiments/student_text.hpp"
#include "server/experiments/units_of_names.hpp"

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

Result<Parameter> read_parameter(const json& element, const std::string& path) {
    ObjectReader reader(
        element,
        path,
        {"name",
         "unit",
         "min",
         "max",
         "step",
         "default",
         "simulated_default",
         "help",
         "simulation_only"}
    );
    Parameter parameter;
    parameter.name = reader.text("name");
    parameter.unit = reader.text("unit");
    parameter.min = reader.number("min");
    parameter.max = reader.number("max");
    parameter.step = reader.number("step");
    parameter.default_value = reader.optional_number("default");
    parameter.simulated_default = reader.optional_number("simulated_default");
    parameter.help = reader.text("help");
    parameter.simulation_only = reader.flag_or("simulation_only", false);
    if (!(parameter.min < parameter.max))
        reader.refuse("min", "is not below max", "give min < max");
    if (!(parameter.step > 0.0)) reader.refuse("step", "is not above 0", "give a positive step");
    for (const auto& [key, value] :
         {std::pair("default", parameter.default_value),
          std::pair("simulated_default", parameter.simulated_default)})
        if (value && (*value < parameter.min || *value > parameter.max))
            reader.refuse(key, "lies outside min and max", "give a default between them");
    const auto promised = unit_in_name(parameter.name);
    if (!promised.empty() && parameter.unit != promised)
        reader.refuse(
            "unit",
            "is \"" + parameter.unit.substr(0, 16) + "\", but the name " + parameter.name +
                " ends as " + std::string(promised) + " does",
            "give the unit " + std::string(promised) + ", or another name"
        );
    if (!reader.ok()) return reader.error();
    if (auto ok = check_student_text(parameter.help, path + ".help"); !ok)
        return tl::unexpected(ok.error());
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
    using End = double (*)(const Parameter&);
    for (const End end :
         {End([](const Parameter& p) { return *p.default_value; }),
          End([](const Parameter& p) { return p.min; }),
          End([](const Parameter& p) { return p.max; })}) {
        Values values;
        for (const auto& parameter : parameters)
            if (parameter.default_value) values[parameter.name] = end(parameter);
        if (auto spec = resolve(element, path, values); !spec)
            return tl::unexpected<Error>(spec.error());
    }
    return ExperimentObject{element.dump()};
}

Result<Definition> load_file(const std::filesystem::path& file) {
    return read_json_file(file).and_then(read_with_schema).map_error([&](Error error) {
        if (error.field != file.string()) error.field = file.string() + ": " + error.field;
        return error;
    });
}

}  // namespace

Result<Definition> read_definition(const json& document) {
    ObjectReader reader(
        document,
        "",
        {"id",
         "title",
         "summary",
         "theory",
         "apparatus",
         "parameters",
         "objects",
         "preprocess",
         "sequence",
         "duration_s",
         "early_end",
         "analysis",
         "plots",
         "acceptance"}
    );
    Definition definition;
    definition.id = reader.text("id");
    definition.title = reader.text("title");
    definition.summary = reader.text("summary");
    definition.theory = reader.text_or("theory", "");
    definition.apparatus = reader.text("apparatus");
    const auto& parameters = reader.array("parameters");
    const auto& objects = reader.array("objects");
    if (reader.ok() && objects.empty())
        reader.refuse(
            "objects",
            "is empty",
            "list what to track, such as {\"name\": \"ball\", \"method\": \"sphere\", "
            "\"radius_m\": 0.04}"
        );
    if (!reader.ok()) return reader.error();

    for (const auto& [text, path] :
         {std::pair(&definition.title, "title"),
          std::pair(&definition.summary, "summary"),
          std::pair(&definition.theory, "theory")}) {
        if (auto ok = check_student_text(*text, path); !ok) return tl::unexpected(ok.error());
    }
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const std::string path = "parameters[" + std::to_string(i) + "]";
        auto parameter = read_parameter(parameters[i], path);
        if (!parameter) return tl::unexpected<Error>(parameter.error());
        for (const auto& other : definition.parameters)
            if (other.name == parameter->name)
                return fail(
                    ErrorCode::invalid_argument,
                    path + ".name",
                    "is \"" + other.name + "\" like another one's",
                    "give every parameter a name of its own"
                );
        definition.parameters.push_back(std::move(*parameter));
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
        auto object = read_experiment_object(
            objects[i], "objects[" + std::to_string(i) + "]", definition.parameters
        );
        if (!object) return tl::unexpected<Error>(object.error());
        definition.objects.push_back(std::move(*object));
    }
    Values usual;
    for (const auto& parameter : definition.parameters)
        if (parameter.default_value) usual[parameter.name] = *parameter.default_value;
    if (auto ok = check_carrying_planes(plan_for(definition, usual).objects); !ok)
        return tl::unexpected(ok.error());
    if (reader.has("preprocess")) {
        auto preprocess = read_preprocess(document["preprocess"], "preprocess");
        if (!preprocess) return tl::unexpected<Error>(preprocess.error());
        definition.preprocess = *preprocess;
    }
    if (auto ok = read_parts(document, definition); !ok) return tl::unexpected(ok.error());
    if (auto ok = check_apparatus(definition); !ok) return tl::unexpected(ok.error());
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
             {"default", p.default_value ? json(*p.default_value) : json()},
             {"help", p.help},
             {"simulation_only", p.simulation_only}}
        );
        if (p.simulated_default) parameters.back()["simulated_default"] = *p.simulated_default;
    }
    json objects = json::array();
    for (const auto& object : definition.objects)
        objects.push_back(json::parse(object.json));
    json document = {
        {"id", definition.id},
        {"title", definition.title},
        {"summary", definition.summary},
        {"theory", definition.theory},
        {"apparatus", definition.apparatus},
        {"parameters", std::move(parameters)},
        {"objects", std::move(objects)}};
    if (definition.preprocess) document["preprocess"] = to_json(*definition.preprocess);
    write_parts(definition, document);
    return document;
}

Result<Definition> read_with_schema(const json& document) {
    auto definition = read_definition(document);  // first: its messages know what is meant
    if (!definition) return definition;
    if (auto ok = check_schema(document); !ok) return tl::unexpected(ok.error());
    return definition;
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
    // The pendulum first: it is what a page shows to somebody who has not chosen.
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
        const auto place = [](const auto& file) {
            return std::pair(file.stem() != "pendulum", file);
        };
        return place(a) < place(b);
    });
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
