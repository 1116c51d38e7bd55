#include "server/experiments/method_settings_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "pipeline/core/nearest_name.hpp"
#include "server/experiments/model_files.hpp"

namespace kinectlab::experiments {
namespace {

constexpr double kMaxRadius = 2.0;  // m, of anything that the sensor sees as a whole

double read_radius(ObjectReader& reader, const std::string& key, double otherwise) {
    const double radius = reader.number_or(key, otherwise);
    if (reader.has(key) && !(radius > 0.0 && radius <= kMaxRadius)) {
        reader.refuse(
            key, "is " + nlohmann::json(radius).dump(), "give metres, above 0 and up to 2"
        );
    }
    return radius;
}

/// A known radius, or bounds of a free one.
template <class Settings>
void read_radii(ObjectReader& reader, Settings& settings) {
    if (reader.has("radius_m")) settings.radius_m = read_radius(reader, "radius_m", 0.0);
    settings.min_radius_m = read_radius(reader, "min_radius_m", settings.min_radius_m);
    settings.max_radius_m = read_radius(reader, "max_radius_m", settings.max_radius_m);
    if (settings.radius_m && (reader.has("min_radius_m") || reader.has("max_radius_m"))) {
        reader.refuse(
            "radius_m",
            "is given together with limits for a free radius",
            "give either radius_m or min_radius_m and max_radius_m"
        );
    }
    if (settings.min_radius_m >= settings.max_radius_m) {
        reader.refuse(
            "min_radius_m", "is not below max_radius_m", "give min_radius_m < max_radius_m"
        );
    }
}

/// One of two words; the first where the key is missing.
template <class Choice>
Choice read_choice(
    ObjectReader& reader, const std::string& key, const char* first, const char* second
) {
    const std::string word = reader.has(key) ? reader.text(key) : first;
    if (reader.ok() && word != first && word != second)
        reader.refuse(
            key,
            "is \"" + word.substr(0, 60) + "\"",
            "give \"" + std::string(first) + "\" or \"" + second + "\""
        );
    return static_cast<Choice>(word == second);
}

LookIn read_in(ObjectReader& reader) {
    return read_choice<LookIn>(reader, "in", "moved", "scene");
}

GuessBy read_search(ObjectReader& reader) {
    return read_choice<GuessBy>(reader, "search", "ransac", "hough");
}

MethodSettings read_sphere(ObjectReader& reader) {
    SphereSettings settings;
    read_radii(reader, settings);
    settings.in = read_in(reader);
    settings.search = read_search(reader);
    return settings;
}

MethodSettings read_plane(ObjectReader& reader) {
    PlaneSettings settings{read_in(reader), read_search(reader)};
    if (!reader.has("under")) return settings;
    settings.under = reader.text("under");
    if (settings.under.empty())
        reader.refuse("under", "is empty", "give the name of the ball that the plane carries");
    for (const char* other : {"in", "search"})
        if (reader.has(other))
            reader.refuse(
                "under",
                "is given together with " + std::string(other),
                "give one of them: under looks wherever the ball is"
            );
    return settings;
}

MethodSettings read_cylinder(ObjectReader& reader) {
    CylinderSettings settings;
    read_radii(reader, settings);
    settings.in = read_in(reader);
    return settings;
}

MethodSettings read_cone(ObjectReader& reader) {
    ConeSettings settings;
    settings.in = read_in(reader);
    if (reader.has("half_angle_deg")) {
        const double angle = reader.number_or("half_angle_deg", 0.0);
        if (reader.ok() && !(angle >= 5.0 && angle <= 70.0))
            reader.refuse(
                "half_angle_deg", "is " + nlohmann::json(angle).dump(), "give degrees, 5 to 70"
            );
        settings.half_angle_rad = angle * std::numbers::pi / 180.0;
    }
    return settings;
}

MethodSettings read_change(ObjectReader& reader) {
    ChangeTrackSettings settings;
    settings.memory_s = reader.number_or("memory_s", settings.memory_s);
    if (settings.memory_s < 0.0 || settings.memory_s > 60.0)
        reader.refuse("memory_s", "is not between 0 and 60", "give seconds, e.g. 2");
    return settings;
}

/// A list of `count` numbers; zeros after an error.
std::vector<double> read_numbers(
    ObjectReader& reader, const std::string& key, std::size_t count, const std::string& cure
) {
    std::vector<double> numbers(count, 0.0);
    const auto& list = reader.array(key);
    if (!reader.ok()) return numbers;
    const auto is_number = [](const nlohmann::json& element) {
        return element.is_number();
    };
    if (list.size() == count && std::all_of(list.begin(), list.end(), is_number))
        return list.get<std::vector<double>>();
    reader.refuse(key, "is not a list of " + std::to_string(count) + " numbers", "give " + cure);
    return numbers;
}

int to_whole(double value) {
    return static_cast<int>(std::clamp(value, -1e6, 1e6));
}

std::vector<int> read_pixels(
    ObjectReader& reader, const std::string& key, std::size_t count, const std::string& names
) {
    std::vector<int> pixels;
    for (const double number : read_numbers(reader, key, count, names + " in pixels")) {
        if (number != std::floor(number))
            reader.refuse(
                key, "has " + nlohmann::json(number).dump(), "give " + names + " in whole pixels"
            );
        pixels.push_back(to_whole(number));
    }
    return pixels;
}

PictureBox read_box(ObjectReader& reader) {
    const auto box = read_pixels(reader, "box", 4, "[left, top, width, height]");
    return {box[0], box[1], box[2], box[3]};
}

PictureBox read_click(ObjectReader& reader) {
    const auto click = read_pixels(reader, "click", 2, "[column, row]");
    return {click[0], click[1], 1, 1};
}

void read_range(ObjectReader& reader, const std::string& key, double& low, double& high) {
    if (!reader.has(key)) return;
    const auto range = read_numbers(reader, key, 2, "[lowest, highest]");
    low = range[0];
    high = range[1];
}

MethodSettings read_colour(ObjectReader& reader) {
    ColourSettings settings;
    if (reader.has("box") && reader.has("click"))
        reader.refuse("click", "is given together with box", "give one of them");
    if (reader.has("box")) settings.box = read_box(reader);
    if (reader.has("click")) settings.box = read_click(reader);
    if (reader.has("hue_deg") || reader.has("saturation") || reader.has("value")) {
        ColourBounds bounds;
        read_range(reader, "hue_deg", bounds.hue_min_deg, bounds.hue_max_deg);
        read_range(reader, "saturation", bounds.saturation_min, bounds.saturation_max);
        read_range(reader, "value", bounds.value_min, bounds.value_max);
        settings.bounds = bounds;
    }
    settings.learn_at_s = reader.number_or("learn_at_s", settings.learn_at_s);
    return settings;
}

int read_fewest_spots(ObjectReader& reader, int otherwise) {
    const double fewest = reader.number_or("fewest_spots", otherwise);
    if (fewest != std::floor(fewest))
        reader.refuse("fewest_spots", "is no whole number", "give a whole number from 4 to 1000");
    return to_whole(fewest);
}

/// Where and when an object is looked at first.
template <class Settings>
void read_first_look(ObjectReader& reader, Settings& settings) {
    if (reader.has("box")) settings.box = read_box(reader);
    settings.learn_at_s = reader.number_or("learn_at_s", settings.learn_at_s);
    settings.fewest_spots = read_fewest_spots(reader, settings.fewest_spots);
}

MethodSettings read_texture(ObjectReader& reader) {
    TextureSettings settings;
    read_first_look(reader, settings);
    if (reader.has("spots")) {
        const std::string spots = reader.text("spots");
        if (spots == "binary")
            settings.spots = TextureSpots::binary;
        else if (spots != "sift")
            reader.refuse("spots", "is \"" + spots.substr(0, 60) + "\"", "give sift or binary");
    }
    return settings;
}

MethodSettings read_sift3d(ObjectReader& reader) {
    Sift3dTrackSettings settings;
    read_first_look(reader, settings);
    settings.scale_m = reader.number_or("scale_m", settings.scale_m);
    return settings;
}

struct MethodReader {
    std::vector<std::string> keys;
    MethodSettings (*read)(ObjectReader&);
};

/// In the order of kTrackingMethods.
const std::array<MethodReader, kTrackingMethods.size()>& readers() {
    static const std::array<MethodReader, kTrackingMethods.size()> all{{
        {{"radius_m", "min_radius_m", "max_radius_m", "in", "search"}, read_sphere},
        {{"memory_s"}, read_change},
        {{"model", "model_unit_m", "seed"}, read_surface_patch},
        {{"hue_deg", "saturation", "value", "box", "click", "learn_at_s"}, read_colour},
        {{"box", "learn_at_s", "spots", "fewest_spots"}, read_texture},
        {{"box", "learn_at_s", "scale_m", "fewest_spots"}, read_sift3d},
        {{"in", "search", "under"}, read_plane},
        {{"radius_m", "min_radius_m", "max_radius_m", "in"}, read_cylinder},
        {{"half_angle_deg", "in"}, read_cone},
    }};
    return all;
}

const MethodReader* reader_of(const std::string& method) {
    const auto* const found = std::find(kTrackingMethods.begin(), kTrackingMethods.end(), method);
    if (found == kTrackingMethods.end()) return nullptr;
    return &readers()[static_cast<std::size_t>(found - kTrackingMethods.begin())];
}

}  // namespace

Result<void> check_method(const std::string& method, const std::string& field) {
    if (reader_of(method) != nullptr) return {};
    const std::vector<std::string> names(kTrackingMethods.begin(), kTrackingMethods.end());
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is \"" + method.substr(0, 60) + "\"",
        did_you_mean(method, names)
    );
}

std::vector<std::string> setting_names(const std::string& method) {
    const auto* reader = reader_of(method);
    return reader == nullptr ? std::vector<std::string>{} : reader->keys;
}

MethodSettings read_settings(ObjectReader& reader, const std::string& method) {
    const auto* found = reader_of(method);
    return found == nullptr ? MethodSettings{} : found->read(reader);
}

}  // namespace kinectlab::experiments
