#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "server/experiments/definition.hpp"

namespace CLI {
class App;
}

namespace kinectlab::commands {

/// Parses and, if that ends the command already (--help, a wrong argument), says its exit status.
/// Help goes to stdout, errors to stderr.
[[nodiscard]] std::optional<int> parse_arguments(CLI::App& app, int argc, char** argv);

/// For CLI11's check(): a number from `low` to `high`. CLI11's own range lets NaN through.
[[nodiscard]] std::function<std::string(const std::string&)> check_number(double low, double high);

/// For CLI11's check() of a path: an empty one is none, e.g. of a variable that was never set.
[[nodiscard]] std::string check_path(const std::string& word);

/// NAME=VALUE for each --set. Errors name what was given.
[[nodiscard]] Result<experiments::Values> parse_settings(const std::vector<std::string>& words);

/// Prints the error and returns the exit status: 2 for a wrong argument, 1 for everything else.
[[nodiscard]] int report(const Error& error);

/// The same with exit status 2 whatever the error, for what stands on the command line.
[[nodiscard]] int report_usage(const Error& error);

}  // namespace kinectlab::commands
