#include "pipeline/track/tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "pipeline/track/change.hpp"
#include "pipeline/track/sphere.hpp"

namespace kinectlab {
namespace {

struct Method {
    const char* name;
    std::unique_ptr<Tracker> (*make)(const RgbdCamera&, std::vector<IndexedSpec>);
};

constexpr std::array kMethods{
    Method{"sphere", make_sphere_tracker},
    Method{"change", make_change_tracker},
};

/// Letters to insert, delete or replace to turn one word into the other (Levenshtein 1966).
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0U);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::string nearest_method(const std::string& name) {
    const auto nearer = [&name](const Method& a, const Method& b) {
        return edit_distance(name, a.name) < edit_distance(name, b.name);
    };
    return std::min_element(kMethods.begin(), kMethods.end(), nearer)->name;
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text;
}

Result<void> check_radius(const std::string& field, double radius_m) {
    if (std::isfinite(radius_m) && radius_m > 0.0 && radius_m <= 2.0) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is " + std::to_string(radius_m),
        "give a radius in metres above 0 and up to 2, e.g. 0.05"
    );
}

Result<void> check(const ObjectSpec& spec, const std::string& path) {
    const bool known = std::any_of(kMethods.begin(), kMethods.end(), [&](const Method& method) {
        return spec.method == method.name;
    });
    if (!known)
        return fail(
            ErrorCode::invalid_argument,
            path + ".method",
            "there is no method \"" + spec.method + "\" to track \"" + spec.name + "\" with",
            "the nearest is \"" + nearest_method(spec.method) + "\"; there are " +
                joined(tracking_methods())
        );
    if (spec.radius_m) return check_radius(path + ".radius_m", *spec.radius_m);
    if (auto ok = check_radius(path + ".min_radius_m", spec.min_radius_m); !ok) return ok;
    if (auto ok = check_radius(path + ".max_radius_m", spec.max_radius_m); !ok) return ok;
    if (spec.min_radius_m < spec.max_radius_m) return {};
    return fail(
        ErrorCode::invalid_argument,
        path + ".min_radius_m",
        "is " + std::to_string(spec.min_radius_m) + ", not below max_radius_m " +
            std::to_string(spec.max_radius_m),
        "give a range, or radius_m alone"
    );
}

Result<void> check_all(std::span<const ObjectSpec> objects) {
    if (objects.empty())
        return fail(
            ErrorCode::invalid_argument, "objects", "is empty", "name at least one object to track"
        );
    std::set<std::string> names;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::string path = "objects[" + std::to_string(i) + "]";
        if (objects[i].name.empty())
            return fail(
                ErrorCode::invalid_argument, path + ".name", "is empty", "give the object a name"
            );
        if (!names.insert(objects[i].name).second)
            return fail(
                ErrorCode::invalid_argument,
                path + ".name",
                "\"" + objects[i].name + "\" is there twice",
                "give every object its own name"
            );
        if (auto ok = check(objects[i], path); !ok) return ok;
    }
    return {};
}

}  // namespace

std::vector<std::string> tracking_methods() {
    std::vector<std::string> names;
    for (const auto& method : kMethods)
        names.emplace_back(method.name);
    return names;
}

Result<std::vector<std::unique_ptr<Tracker>>> make_trackers(
    const RgbdCamera& camera, std::span<const ObjectSpec> objects
) {
    if (auto ok = check_all(objects); !ok) return tl::unexpected(ok.error());
    std::vector<std::unique_ptr<Tracker>> trackers;
    for (const auto& method : kMethods) {
        std::vector<IndexedSpec> own;
        for (std::size_t i = 0; i < objects.size(); ++i)
            if (objects[i].method == method.name)
                own.push_back({static_cast<std::uint32_t>(i), objects[i]});
        if (!own.empty()) trackers.push_back(method.make(camera, std::move(own)));
    }
    return trackers;
}

}  // namespace kinectlab
