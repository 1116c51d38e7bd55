#include "server/experiments/strict_json.hpp"

#include <cmath>
#include <fstream>
#include <set>

#include "pipeline/core/nearest_name.hpp"

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxBytes = 1U << 20U;
constexpr int kMaxDepth = 32;

std::string join(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace

Result<json> parse_json(std::string_view text, const std::string& name) {
    std::vector<std::set<std::string>> keys;  // of the objects around the place being read
    std::string twice;
    bool too_deep = false;
    const auto watch = [&](int depth, json::parse_event_t event, json& value) {
        too_deep = too_deep || depth > kMaxDepth;
        if (event == json::parse_event_t::object_start) keys.emplace_back();
        if (event == json::parse_event_t::object_end) keys.pop_back();
        if (event == json::parse_event_t::key) {
            const auto& key = value.get_ref<const std::string&>();
            if (!keys.back().insert(key).second && twice.empty()) twice = key;
        }
        return true;
    };
    try {
        json parsed = json::parse(text, watch);
        if (too_deep) {
            return fail(ErrorCode::bad_data, name, "is nested too deeply", "give a plain object");
        }
        if (!twice.empty()) {
            return fail(
                ErrorCode::bad_data,
                name,
                "has the key \"" + twice + "\" twice in one object",
                "give every key once"
            );
        }
        return parsed;
    } catch (const json::exception& problem) {
        std::string what = problem.what();
        const auto start = what.find("] ");  // the library's own number says nothing to a reader
        if (start != std::string::npos) what = what.substr(start + 2);
        return fail(
            ErrorCode::bad_data, name, "is not valid JSON: " + what, "correct the JSON there"
        );
    }
}

Result<json> read_json_file(const std::filesystem::path& file) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code)) {
        return fail(
            ErrorCode::not_found,
            file.string(),
            "is not there, or not a file",
            "give the path of a JSON file"
        );
    }
    if (std::filesystem::file_size(file, code) > kMaxBytes || code) {
        return fail(
            ErrorCode::bad_data,
            file.string(),
            "is larger than 1 MiB",
            "give a JSON file of a few kilobytes"
        );
    }
    std::ifstream stream(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream) {
        return fail(
            ErrorCode::bad_data, file.string(), "could not be read", "check its permissions"
        );
    }
    return parse_json(text, file.string());
}

ObjectReader::ObjectReader(const json& json, std::string path, std::vector<std::string> keys)
    : json_(json), path_(std::move(path)) {
    if (!json.is_object()) {
        error_ = Error{
            ErrorCode::invalid_argument,
            path_,
            std::string("is of type ") + json.type_name(),
            "give an object with " + join(keys)};
        return;
    }
    for (const auto& [key, value] : json.items()) {
        if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
        refuse(key, "is not known", did_you_mean(key, keys));
        return;
    }
}

bool ObjectReader::has(const std::string& key) const {
    return json_.is_object() && json_.contains(key);
}

std::string ObjectReader::path_of(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
}

void ObjectReader::refuse(const std::string& key, std::string message, std::string cure) {
    if (error_) return;
    error_ = Error{ErrorCode::invalid_argument, path_of(key), std::move(message), std::move(cure)};
}

const json* ObjectReader::member(const std::string& key, const std::string& cure) {
    if (error_) return nullptr;
    const auto found = json_.find(key);
    if (found != json_.end()) return &*found;
    refuse(key, "is missing", cure);
    return nullptr;
}

std::string ObjectReader::text(const std::string& key) {
    const json* value = member(key, "give a text");
    if (value == nullptr) return {};
    if (value->is_string()) return value->get<std::string>();
    refuse(key, "is " + value->dump().substr(0, 60), "give a text");
    return {};
}

double ObjectReader::number(const std::string& key) {
    const json* value = member(key, "give a number");
    if (value == nullptr) return 0.0;
    if (value->is_number() && std::isfinite(value->get<double>())) return value->get<double>();
    refuse(key, "is " + value->dump().substr(0, 60), "give a number");
    return 0.0;
}

double ObjectReader::number_or(const std::string& key, double otherwise) {
    return has(key) ? number(key) : otherwise;
}

std::string ObjectReader::text_or(const std::string& key, const std::string& otherwise) {
    return has(key) ? text(key) : otherwise;
}

std::optional<double> ObjectReader::optional_number(const std::string& key) {
    if (error_ || !has(key) || json_.at(key).is_null()) return std::nullopt;
    return number(key);
}

bool ObjectReader::flag_or(const std::string& key, bool otherwise) {
    if (error_ || !has(key)) return otherwise;
    const json& value = json_.at(key);
    if (value.is_boolean()) return value.get<bool>();
    refuse(key, "is " + value.dump().substr(0, 60), "give true or false");
    return otherwise;
}

const json& ObjectReader::array(const std::string& key) {
    static const json kNone = json::array();
    const json* value = member(key, "give a list");
    if (value == nullptr) return kNone;
    if (value->is_array()) return *value;
    refuse(key, std::string("is of type ") + value->type_name(), "give a list");
    return kNone;
}

}  // namespace kinectlab::experiments
