#include "server/experiments/objects_json.hpp"

#include <cctype>

#include "pipeline/track/carrying_plane.hpp"
#include "server/experiments/method_settings_json.hpp"
#include "server/experiments/model_files.hpp"
#include "server/experiments/preprocess_json.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

constexpr std::size_t kMaxObjects = 64;
constexpr std::size_t kMaxNameLength = 64;

// Names stand in CSV files that spreadsheets open: nothing that would need quotes or start a
// formula.
bool is_plain_name(const std::string& name) {
    if (name.empty() || name.size() > kMaxNameLength) return false;
    const auto is_letter = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0;
    };
    const auto is_fine = [&](char c) {
        return is_letter(c) || c == '_' || c == '-' || c == '.' || c == ' ';
    };
    return is_letter(name.front()) && std::all_of(name.begin(), name.end(), is_fine);
}

}  // namespace

Result<ObjectSpec> read_object(const nlohmann::json& element, const std::string& path) {
    // The method decides which keys are right, so a wrong method is told before a wrong key.
    std::string method;
    if (element.is_object() && element.contains("method") && element["method"].is_string()) {
        method = element["method"].get<std::string>();
        if (auto known = check_method(method, path + ".method"); !known)
            return tl::unexpected<Error>(known.error());
    }
    std::vector<std::string> keys = {"name", "method"};
    const auto settings = setting_names(method);
    keys.insert(keys.end(), settings.begin(), settings.end());

    ObjectReader reader(element, path, keys);
    ObjectSpec spec;
    spec.name = reader.text("name");
    (void)reader.text("method");
    if (reader.ok() && !is_plain_name(spec.name)) {
        reader.refuse(
            "name",
            "is \"" + spec.name.substr(0, 60) + "\"",
            "give 1 to 64 letters, digits, spaces or _ - . that begin with a letter or digit"
        );
    }
    if (reader.ok()) spec.settings = read_settings(reader, method);
    if (!reader.ok()) return reader.error();
    return spec;
}

Result<TrackingPlan> read_tracking_plan(const nlohmann::json& document) {
    ObjectReader reader(document, "", {"objects", "preprocess"});
    const auto& list = reader.array("objects");
    if (reader.ok() && (list.empty() || list.size() > kMaxObjects)) {
        reader.refuse(
            "objects", "has " + std::to_string(list.size()) + " entries", "give 1 to 64 objects"
        );
    }
    if (!reader.ok()) return reader.error();

    TrackingPlan plan;
    if (reader.has("preprocess")) {
        auto preprocess = read_preprocess(document["preprocess"], "preprocess");
        if (!preprocess) return tl::unexpected<Error>(preprocess.error());
        plan.preprocess = *preprocess;
    }
    auto& objects = plan.objects;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string path = "objects[" + std::to_string(i) + "]";
        auto object = read_object(list[i], path);
        if (!object) return tl::unexpected<Error>(object.error());
        for (const auto& other : objects) {
            if (other.name != object->name) continue;
            return fail(
                ErrorCode::invalid_argument,
                path + ".name",
                "is \"" + object->name + "\" a second time",
                "give every object a name of its own"
            );
        }
        objects.push_back(std::move(*object));
    }
    if (auto ok = check_carrying_planes(objects); !ok) return tl::unexpected(ok.error());
    return plan;
}

Result<TrackingPlan> load_tracking_plan(const std::filesystem::path& file) {
    const auto beside = [&](nlohmann::json document) {
        return with_models_beside(file, std::move(document));
    };
    return read_json_file(file)
        .map(beside)
        .and_then(read_tracking_plan)
        .map_error([&](Error error) {
            if (error.field == file.string()) return error;
            error.field = file.string() + (error.field.empty() ? "" : ": " + error.field);
            return error;
        });
}

}  // namespace kinectlab::experiments
