#include "server/commands/arguments.hpp"

#include <charconv>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "server/commands/commands.hpp"

namespace kinectlab::commands {

std::optional<int> parse_arguments(CLI::App& app, int argc, char** argv) {
    try {
        app.parse(argc, argv);
        return std::nullopt;
    } catch (const CLI::CallForHelp&) {
        std::fputs(app.help().c_str(), stdout);
        return kOk;
    } catch (const CLI::ParseError& error) {
        std::fprintf(
            stderr, "%s\n`kinectlab %s --help` tells the arguments\n", error.what(), argv[0]
        );
        return kUsage;
    }
}

std::function<std::string(const std::string&)> check_number(double low, double high) {
    return [low, high](const std::string& word) -> std::string {
        double value = 0.0;
        const char* end = word.data() + word.size();
        const auto read = std::from_chars(word.data(), end, value);
        const bool whole = read.ec == std::errc() && read.ptr == end;
        if (whole && value >= low && value <= high) return {};  // false for NaN
        return fmt::format("is {}; give a number from {} to {}", word.substr(0, 40), low, high);
    };
}

std::string check_path(const std::string& word) {
    return word.empty() ? "is empty; give a path" : "";
}

Result<experiments::Values> parse_settings(const std::vector<std::string>& words) {
    experiments::Values values;
    for (const auto& word : words) {
        const std::size_t sign = word.find('=');
        const std::string name = word.substr(0, sign);
        const bool named = sign != std::string::npos && !name.empty();
        double value = 0.0;
        bool fine = named;
        if (fine) {
            const char* end = word.data() + word.size();
            const auto read = std::from_chars(word.data() + sign + 1, end, value);
            fine = read.ec == std::errc() && read.ptr == end;
        }
        if (!fine)
            return fail(
                ErrorCode::invalid_argument,
                name.empty() ? "--set" : name,
                "\"" + word.substr(0, 80) + "\" is no NAME=NUMBER",
                named ? "give a number, e.g. --set " + name.substr(0, 40) + "=0.8"
                      : "give e.g. --set length_m=0.8"
            );
        if (!values.emplace(name, value).second)
            return fail(ErrorCode::invalid_argument, name, "is set twice", "set it once");
    }
    return values;
}

int report(const Error& error) {
    std::fprintf(stderr, "%s\n", to_text(error).c_str());
    return error.code == ErrorCode::invalid_argument ? kUsage : kFailed;
}

int report_usage(const Error& error) {
    std::fprintf(stderr, "%s\n", to_text(error).c_str());
    return kUsage;
}

}  // namespace kinectlab::commands
