#include "server/experiments/model_files.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "pipeline/sensor/mesh_file.hpp"
#include "server/experiments/share_dir.hpp"

namespace kinectlab::experiments {

nlohmann::json with_models_beside(const std::filesystem::path& file, nlohmann::json document) {
    if (!document.is_object() || !document.contains("objects") || !document["objects"].is_array())
        return document;
    const auto folder = std::filesystem::absolute(file).parent_path();
    for (auto& object : document["objects"]) {
        if (!object.is_object() || !object.contains("model") || !object["model"].is_string())
            continue;
        const std::filesystem::path model = object["model"].get<std::string>();
        if (model.is_relative() && !model.empty())
            object["model"] = (folder / model).lexically_normal().string();
    }
    return document;
}

MethodSettings read_surface_patch(ObjectReader& reader) {
    SurfacePatchSettings settings;
    settings.model = reader.text("model");
    settings.model_unit_m = reader.number_or("model_unit_m", settings.model_unit_m);
    const double seed = reader.number_or("seed", settings.seed);
    if (!(settings.model_unit_m > 0.0 && settings.model_unit_m <= 1000.0))
        reader.refuse(
            "model_unit_m",
            "is " + nlohmann::json(settings.model_unit_m).dump(),
            "give metres for each unit of the model, e.g. 0.001 for millimetres"
        );
    if (!(seed >= 0.0 && seed <= 4294967295.0 && seed == std::floor(seed)))
        reader.refuse("seed", "is no whole number", "give 0 to 4294967295");
    if (!reader.ok()) return settings;
    settings.seed = static_cast<std::uint32_t>(seed);
    const std::filesystem::path model = settings.model;
    const bool own = model.is_relative() && !model.empty();
    auto file = read_mesh(own ? (share_dir() / "experiments" / model).string() : settings.model);
    if (!file) {
        const Error& error = file.error();
        reader.refuse("model", error.field + " " + error.message, error.cure);
        return settings;
    }
    const auto name = std::filesystem::path(settings.model).filename().string();
    settings.warnings = mesh_warnings(*file, name, settings.model_unit_m);
    settings.mesh = std::make_shared<const TriangleMesh>(std::move(file->mesh));
    return settings;
}

std::vector<std::string> warnings_of(const std::vector<ObjectSpec>& objects) {
    std::vector<std::string> all;
    for (const auto& object : objects)
        if (const auto* settings = std::get_if<SurfacePatchSettings>(&object.settings))
            for (const auto& warning : settings->warnings)
                all.push_back(object.name + ": " + warning);
    return all;
}

}  // namespace kinectlab::experiments
