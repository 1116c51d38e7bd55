#include "server/experiments/preprocess_json.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <nlohmann/json.hpp>

#include "pipeline/core/nearest_name.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

/// One method of a stage: its name, its keys, and what it sets.
struct Method {
    std::string_view name;
    std::vector<std::string> keys;
    std::function<void(ObjectReader&, PreprocessSettings&)> read;
};

struct Stage {
    const char* key;
    std::vector<Method> methods;
};

int whole(ObjectReader& reader, const std::string& key, int otherwise) {
    const double value = reader.number_or(key, otherwise);
    if (value == std::floor(value) && std::abs(value) < 1e9) return static_cast<int>(value);
    reader.refuse(key, "is " + json(value).dump(), "give a whole number");
    return otherwise;
}

void read_outliers(ObjectReader& reader, PreprocessSettings& settings) {
    OutlierSettings outliers;
    outliers.neighbours = whole(reader, "neighbours", outliers.neighbours);
    outliers.sigma_factor = reader.number_or("sigma_factor", outliers.sigma_factor);
    settings.outliers = outliers;
}

void read_smoothing(ObjectReader& reader, PreprocessSettings& settings) {
    MovingLeastSquaresSettings smoothing;
    const int order = whole(reader, "order", 2);
    if (order != 1 && order != 2)
        reader.refuse("order", "is " + std::to_string(order), "give 1 (linear) or 2 (quadratic)");
    smoothing.basis = order == 1 ? Basis::linear : Basis::quadratic;
    smoothing.radius_m = reader.number_or("radius_m", smoothing.radius_m);
    smoothing.epsilon_m = reader.number_or("epsilon_m", smoothing.radius_m);
    settings.smoothing = smoothing;
}

template <class Name>
std::string_view name_of(Name method, const auto& names) {
    return names[static_cast<std::size_t>(method)];
}

Method cut(CutMethod method, std::vector<std::string> keys = {}) {
    return {name_of(method, kCutMethods), std::move(keys), [method](ObjectReader& reader, auto& s) {
                s.depth_cut.method = method;
                s.depth_cut.farthest_m = reader.number_or("farthest_m", s.depth_cut.farthest_m);
            }};
}

Method reference(ReferenceMethod method, std::vector<std::string> keys = {}) {
    return {
        name_of(method, kReferenceMethods),
        std::move(keys),
        [method](ObjectReader& reader, auto& s) {
            s.reference.method = method;
            s.reference.seconds = reader.number_or("seconds", s.reference.seconds);
        }};
}

Method change(ChangeMethod method, std::vector<std::string> keys) {
    return {
        name_of(method, kChangeMethods), std::move(keys), [method](ObjectReader& reader, auto& s) {
            auto& change = s.change;
            change.method = method;
            change.threshold_steps = reader.number_or("threshold_steps", change.threshold_steps);
            change.voxel_m = reader.number_or("voxel_m", change.voxel_m);
            change.least_points = whole(reader, "least_points", change.least_points);
        }};
}

Method connected() {
    return {"connected", {"min_points"}, [](ObjectReader& reader, auto& s) {
                s.min_segment_points = whole(reader, "min_points", s.min_segment_points);
            }};
}

const std::vector<Stage>& stages() {
    static const std::vector<Stage> all{
        {"outliers",
         {{"statistical", {"neighbours", "sigma_factor"}, read_outliers},
          {"none",
           {},
           [](ObjectReader&, auto& s) {
               s.outliers.reset();
           }}}},
        {"smoothing",
         {{"moving_least_squares", {"order", "radius_m", "epsilon_m"}, read_smoothing},
          {"none",
           {},
           [](ObjectReader&, auto& s) {
               s.smoothing.reset();
           }}}},
        {"depth_cut",
         {cut(CutMethod::wall), cut(CutMethod::fixed, {"farthest_m"}), cut(CutMethod::none)}},
        {"reference",
         {reference(ReferenceMethod::scene),
          reference(ReferenceMethod::rolling, {"seconds"}),
          reference(ReferenceMethod::median, {"seconds"})}},
        {"change",
         {change(ChangeMethod::image_grid, {"threshold_steps"}),
          change(ChangeMethod::octree, {"voxel_m", "least_points", "threshold_steps"})}},
        {"segments", {connected()}},
    };
    return all;
}

/// The method decides which keys are right, so a wrong method is told before a wrong key.
Result<void> read_stage(
    const json& element, const std::string& path, const Stage& stage, PreprocessSettings& settings
) {
    std::vector<std::string> names;
    for (const auto& method : stage.methods)
        names.emplace_back(method.name);
    std::string name(stage.methods.front().name);
    const bool told = element.is_object() && element.contains("method");
    if (told && element["method"].is_string()) name = element["method"].get<std::string>();
    const auto method = std::find_if(
        stage.methods.begin(), stage.methods.end(), [&](const Method& m) { return m.name == name; }
    );
    if (method == stage.methods.end())
        return fail(
            ErrorCode::invalid_argument,
            path + ".method",
            "is \"" + name.substr(0, 60) + "\"",
            did_you_mean(name, names)
        );
    std::vector<std::string> keys = {"method"};
    keys.insert(keys.end(), method->keys.begin(), method->keys.end());
    ObjectReader reader(element, path, keys);
    if (told) (void)reader.text("method");
    if (reader.ok()) method->read(reader, settings);
    if (!reader.ok()) return reader.error();
    return {};
}

}  // namespace

Result<PreprocessSettings> read_preprocess(const json& element, const std::string& path) {
    std::vector<std::string> keys;
    for (const auto& stage : stages())
        keys.emplace_back(stage.key);
    const ObjectReader reader(element, path, keys);
    if (!reader.ok()) return reader.error();
    PreprocessSettings settings;
    for (const auto& stage : stages()) {
        if (!element.contains(stage.key)) continue;
        auto read = read_stage(element[stage.key], path + "." + stage.key, stage, settings);
        if (!read) return tl::unexpected<Error>(read.error());
    }
    if (auto ok = check(settings); !ok) return tl::unexpected<Error>(ok.error());
    return settings;
}

json to_json(const PreprocessSettings& settings) {
    json all = {
        {"outliers", {{"method", "none"}}},
        {"smoothing", {{"method", "none"}}},
        {"depth_cut", {{"method", name_of(settings.depth_cut.method, kCutMethods)}}},
        {"reference", {{"method", name_of(settings.reference.method, kReferenceMethods)}}},
        {"change", {{"method", name_of(settings.change.method, kChangeMethods)}}},
        {"segments", {{"method", "connected"}, {"min_points", settings.min_segment_points}}}};
    if (const auto& outliers = settings.outliers)
        all["outliers"] = {
            {"method", "statistical"},
            {"neighbours", outliers->neighbours},
            {"sigma_factor", outliers->sigma_factor}};
    if (const auto& smoothing = settings.smoothing)
        all["smoothing"] = {
            {"method", "moving_least_squares"},
            {"order", static_cast<int>(smoothing->basis)},
            {"radius_m", smoothing->radius_m},
            {"epsilon_m", smoothing->epsilon_m}};
    if (settings.depth_cut.method == CutMethod::fixed)
        all["depth_cut"]["farthest_m"] = settings.depth_cut.farthest_m;
    if (settings.reference.method != ReferenceMethod::scene)
        all["reference"]["seconds"] = settings.reference.seconds;
    all["change"]["threshold_steps"] = settings.change.threshold_steps;
    if (settings.change.method == ChangeMethod::octree) {
        all["change"]["voxel_m"] = settings.change.voxel_m;
        all["change"]["least_points"] = settings.change.least_points;
    }
    return all;
}

}  // namespace kinectlab::experiments
