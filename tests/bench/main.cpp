#include <cstdio>
#include <fstream>
#include <iostream>
#include <regex>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/bench/measurements.hpp"

namespace {

using namespace kinectlab::bench;

constexpr const char* kUsage =
    "bench [--list] [--filter REGEX] [--json FILE]\n"
    "Measures the figures that the project claims, each beside its peer in the same run.\n"
    "  --list          the names that --filter is compared with, one a line; measures nothing\n"
    "  --filter REGEX  only figures whose name matches\n"
    "  --json FILE     also write them as JSON\n";

struct Options {
    std::string filter = ".*";
    std::string json;
    bool help = false;
    bool list = false;
};

/// Throws std::invalid_argument with a line for the user.
Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--help") {
            options.help = true;
        } else if (word == "--list") {
            options.list = true;
        } else if ((word == "--filter" || word == "--json") && i + 1 < argc) {
            (word == "--filter" ? options.filter : options.json) = argv[++i];
        } else {
            throw std::invalid_argument("unknown or incomplete option " + word);
        }
    }
    return options;
}

nlohmann::json to_json(const Figure& figure) {
    const auto or_null = [](const auto& value) {
        return value ? nlohmann::json(*value) : nlohmann::json();
    };
    return {
        {"figure", figure.name},
        {"value", figure.value},
        {"unit", figure.unit},
        {"bound", or_null(figure.bound)},
        {"met", or_null(figure.met())},
        {"peer", or_null(figure.peer)},
        {"ratio", or_null(figure.ratio())},
    };
}

std::string number(std::optional<double> value) {
    if (!value) return "";
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", *value);
    return text;
}

void print(const Figure& figure) {
    const auto met = figure.met();
    const std::string bound =
        figure.bound ? (figure.better == Better::lower ? "<= " : ">= ") + number(figure.bound) : "";
    std::string peer = number(figure.peer);
    if (!peer.empty()) peer += " " + figure.peer_name;
    if (figure.ratio()) peer += " (" + number(figure.ratio()) + "x)";
    std::printf(
        "%-58s %10s %-8s %-9s %-7s %s\n",
        figure.name.c_str(),
        number(figure.value).c_str(),
        figure.unit.c_str(),
        bound.c_str(),
        met ? (*met ? "met" : "NOT met") : "",
        peer.c_str()
    );
    std::fflush(stdout);
}

int list(const Options& options) {
    const std::regex filter(options.filter, std::regex::icase);
    for (const auto& measurement : kMeasurements)
        if (std::regex_search(measurement.figures, filter))
            std::printf("%s\n", measurement.figures);
    return 0;
}

int run(const Options& options) {
    const std::regex filter(options.filter, std::regex::icase);
    std::printf("%-58s %10s %-8s %-9s %-7s %s\n", "figure", "value", "unit", "bound", "", "peer");
    nlohmann::json all = nlohmann::json::array();
    for (const auto& measurement : kMeasurements) {
        if (!std::regex_search(measurement.figures, filter)) continue;
        for (const auto& figure : measurement.measure()) {
            print(figure);
            all.push_back(to_json(figure));
        }
    }
    if (options.json.empty()) return 0;
    std::ofstream file(options.json);
    file << all.dump(2) << '\n';
    file.close();
    if (file) return 0;
    std::cerr << "cannot write " << options.json << '\n';
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Options options = parse(argc, argv);
        if (options.help) {
            std::cout << kUsage;
            return 0;
        }
        return options.list ? list(options) : run(options);
    } catch (const std::invalid_argument& wrong) {
        std::cerr << wrong.what() << '\n' << kUsage;
    } catch (const std::regex_error& wrong) {
        std::cerr << "--filter: " << wrong.what() << '\n' << kUsage;
    }
    return 2;
}
