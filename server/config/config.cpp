#include "server/config/config.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include <unistd.h>

#include "pipeline/core/nearest_name.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::config {
namespace {

using experiments::ObjectReader;
using nlohmann::json;

const std::vector<std::string> kLogLevels{"debug", "info", "warn", "error"};
const std::vector<std::string> kVariables{
    "KINECTLAB_LISTEN", "KINECTLAB_DATA_DIR", "KINECTLAB_LOG_LEVEL"};

std::filesystem::path default_data_dir(const Environment& environment) {
    const auto data_home = environment.find("XDG_DATA_HOME");
    if (data_home != environment.end() && !data_home->second.empty()) {
        return std::filesystem::path(data_home->second) / "kinectlab";
    }
    const auto home = environment.find("HOME");
    if (home == environment.end() || home->second.empty()) return "kinectlab-data";
    return std::filesystem::path(home->second) / ".local/share/kinectlab";
}

std::vector<RigConfig> default_rigs() {
    return {{"rig-1", "Rig 1", "sim://rig-1", {}}, {"rig-2", "Rig 2", "sim://rig-2", {}}};
}

bool is_rig_id(const std::string& id) {
    const auto allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
    };
    return !id.empty() && id.size() <= 32 && std::all_of(id.begin(), id.end(), allowed);
}

Result<RigConfig> read_rig(const json& element, const std::string& path) {
    ObjectReader reader(element, path, {"id", "name", "uri", "experiments"});
    RigConfig rig;
    rig.id = reader.text("id");
    if (reader.ok() && !is_rig_id(rig.id)) {
        reader.refuse("id", "is '" + rig.id + "'", "give 1 to 32 of a-z, 0-9 and dash, e.g. rig-1");
    }
    rig.name = reader.has("name") ? reader.text("name") : rig.id;
    rig.uri = reader.text("uri");
    if (reader.has("experiments")) {
        rig.experiments.clear();
        for (const auto& name : reader.array("experiments")) {
            if (!name.is_string()) {
                reader.refuse("experiments", "holds " + name.dump(), "give a list of names");
                break;
            }
            rig.experiments.push_back(name.get<std::string>());
        }
    }
    if (!reader.ok()) return reader.error();
    return rig;
}

Result<std::vector<RigConfig>> read_rigs(const json& list) {
    std::vector<RigConfig> rigs;
    std::set<std::string> ids;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string path = "rigs[" + std::to_string(i) + "]";
        auto rig = read_rig(list[i], path);
        if (!rig) return tl::unexpected(rig.error());
        if (!ids.insert(rig->id).second) {
            return fail(
                ErrorCode::invalid_argument,
                path + ".id",
                "is '" + rig->id + "', as another rig's",
                "give every rig its own id"
            );
        }
        rigs.push_back(std::move(*rig));
    }
    if (rigs.empty()) {
        return fail(ErrorCode::invalid_argument, "rigs", "is empty", "give at least one rig");
    }
    return rigs;
}

Result<std::string> check_log_level(const std::string& field, const std::string& level) {
    if (std::find(kLogLevels.begin(), kLogLevels.end(), level) != kLogLevels.end()) return level;
    return fail(
        ErrorCode::invalid_argument, field, "is '" + level + "'", did_you_mean(level, kLogLevels)
    );
}

Result<void> apply_file(Config& config, const std::filesystem::path& file) {
    const auto document = experiments::read_json_file(file);
    if (!document) return tl::unexpected(document.error());
    ObjectReader reader(*document, "", {"listen", "data_dir", "log_level", "rigs"});
    if (reader.has("listen")) {
        auto listen = parse_address(reader.text("listen"));
        if (reader.ok() && !listen) return tl::unexpected(listen.error());
        if (listen) config.listen = *listen;
    }
    if (reader.has("data_dir")) {
        // Relative to the file that says so, wherever the program is started.
        config.data_dir = file.parent_path() / reader.text("data_dir");
    }
    if (reader.has("log_level")) {
        auto level = check_log_level("log_level", reader.text("log_level"));
        if (reader.ok() && !level) return tl::unexpected(level.error());
        if (level) config.log_level = *level;
    }
    if (reader.has("rigs")) {
        auto rigs = read_rigs(reader.array("rigs"));
        if (reader.ok() && !rigs) return tl::unexpected(rigs.error());
        if (rigs) config.rigs = std::move(*rigs);
    }
    if (!reader.ok()) return reader.error();
    return {};
}

/// Variables of tests and scripts begin with KINECTLAB_ too, so only near misses are refused.
Result<void> check_variable(const std::string& name) {
    for (const auto& valid : kVariables) {
        if (name == valid || edit_distance(name, valid) > 2) continue;
        return fail(
            ErrorCode::invalid_argument, name, "is not known", "did you mean " + valid + "?"
        );
    }
    return {};
}

Result<void> apply_environment(Config& config, const Environment& environment) {
    for (const auto& [name, value] : environment) {
        if (!name.starts_with("KINECTLAB_")) continue;
        if (auto ok = check_variable(name); !ok) return ok;
        if (name == "KINECTLAB_LISTEN") {
            auto listen = parse_address(value);
            if (!listen) return tl::unexpected(listen.error());
            config.listen = *listen;
        } else if (name == "KINECTLAB_DATA_DIR") {
            config.data_dir = value;
        } else if (name == "KINECTLAB_LOG_LEVEL") {
            auto level = check_log_level(name, value);
            if (!level) return tl::unexpected(level.error());
            config.log_level = *level;
        }
    }
    return {};
}

}  // namespace

Result<Address> parse_address(std::string_view text) {
    const auto refuse = [&]() -> Result<Address> {
        return fail(
            ErrorCode::invalid_argument,
            "listen",
            "is '" + std::string(text) + "'",
            "give ADDRESS:PORT, for example 127.0.0.1:8080"
        );
    };
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos) return refuse();
    Address address;
    std::string_view host = text.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) {
        host = host.substr(1, host.size() - 2);
    } else if (host.find(':') != std::string_view::npos) {
        return refuse();  // IPv6 without brackets leaves open where the port begins
    }
    if (!host.empty()) address.host = host;
    if (address.host == "localhost") address.host = "127.0.0.1";
    const std::string_view port = text.substr(colon + 1);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error != std::errc() || end != port.data() + port.size()) return refuse();
    return address;
}

Result<Config> read_config(
    const std::optional<std::filesystem::path>& file, const Environment& environment
) {
    Config config;
    config.data_dir = default_data_dir(environment);
    config.rigs = default_rigs();
    if (file) {
        if (auto ok = apply_file(config, *file); !ok) return tl::unexpected(ok.error());
    }
    if (auto ok = apply_environment(config, environment); !ok) return tl::unexpected(ok.error());
    return config;
}

Environment environment() {
    Environment all;
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        const std::string_view text(*entry);
        const auto equals = text.find('=');
        if (equals == std::string_view::npos) continue;
        all[std::string(text.substr(0, equals))] = text.substr(equals + 1);
    }
    return all;
}

}  // namespace kinectlab::config
