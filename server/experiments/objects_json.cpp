#include "server/experiments/objects_json.hpp"

#include <cctype>

#include "pipeline/core/nearest_name.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

constexpr double kMaxRadius = 5.0;  // m, as far as the sensor sees
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

double read_radius(ObjectReader& reader, const std::string& key, double otherwise) {
    const double radius = reader.number_or(key, otherwise);
    if (reader.has(key) && !(radius > 0.0 && radius <= kMaxRadius)) {
        reader.refuse(
            key, "is " + nlohmann::json(radius).dump(), "give metres, above 0 and up to 5"
        );
    }
    return radius;
}

void read_sphere(ObjectReader& reader, ObjectSpec& spec) {
    if (reader.has("radius_m")) spec.radius_m = read_radius(reader, "radius_m", 0.0);
    spec.min_radius_m = read_radius(reader, "min_radius_m", spec.min_radius_m);
    spec.max_radius_m = read_radius(reader, "max_radius_m", spec.max_radius_m);
    if (spec.radius_m && (reader.has("min_radius_m") || reader.has("max_radius_m"))) {
        reader.refuse(
            "radius_m",
            "is given together with limits for a free radius",
            "give either radius_m or min_radius_m and max_radius_m"
        );
    }
    if (spec.min_radius_m >= spec.max_radius_m) {
        reader.refuse(
            "min_radius_m", "is not below max_radius_m", "give min_radius_m < max_radius_m"
        );
    }
}

}  // namespace

Result<ObjectSpec> read_object(const nlohmann::json& element, const std::string& path) {
    static const std::vector<std::string> kMethods = {"sphere", "change"};
    const bool is_sphere =
        element.is_object() && element.value("method", nlohmann::json()) == "sphere";
    std::vector<std::string> keys = {"name", "method"};
    if (is_sphere) keys.insert(keys.end(), {"radius_m", "min_radius_m", "max_radius_m"});

    ObjectSpec spec;
    // The method decides which keys are right, so a wrong method is told before a wrong key.
    if (element.is_object() && element.contains("method") && element["method"].is_string()) {
        const auto method = element["method"].get<std::string>();
        if (std::find(kMethods.begin(), kMethods.end(), method) == kMethods.end()) {
            return fail(
                ErrorCode::invalid_argument,
                path + ".method",
                "is \"" + method.substr(0, 60) + "\"",
                "did you mean " + nearest_name(method, kMethods) + "? Valid: sphere, change"
            );
        }
    }
    ObjectReader reader(element, path, keys);
    spec.name = reader.text("name");
    spec.method = reader.text("method");
    if (reader.ok() && !is_plain_name(spec.name)) {
        reader.refuse(
            "name",
            "is \"" + spec.name.substr(0, 60) + "\"",
            "give 1 to 64 letters, digits, spaces or _ - . that begin with a letter or digit"
        );
    }
    if (is_sphere) read_sphere(reader, spec);
    if (!reader.ok()) return reader.error();
    return spec;
}

Result<std::vector<ObjectSpec>> read_objects(const nlohmann::json& document) {
    ObjectReader reader(document, "", {"objects"});
    const auto& list = reader.array("objects");
    if (reader.ok() && (list.empty() || list.size() > kMaxObjects)) {
        reader.refuse(
            "objects", "has " + std::to_string(list.size()) + " entries", "give 1 to 64 objects"
        );
    }
    if (!reader.ok()) return reader.error();

    std::vector<ObjectSpec> objects;
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
    return objects;
}

Result<std::vector<ObjectSpec>> load_objects(const std::filesystem::path& file) {
    return read_json_file(file).and_then(read_objects).map_error([&](Error error) {
        if (error.field != file.string()) error.field = file.string() + ": " + error.field;
        return error;
    });
}

}  // namespace kinectlab::experiments
