#include "server/commands/commands.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "pipeline/core/nearest_name.hpp"
#include "server/config/version.hpp"

namespace kinectlab::commands {
namespace {

constexpr Command kCommands[] = {
    {"serve", "serve the laboratory: rigs, bookings, live view", serve},
    {"simulate", "record a simulated experiment", simulate},
    {"track", "follow objects in a recording", track},
    {"analyse", "measure with a recording of an experiment", analyse},
    {"user", "add and list people, reset passwords", user},
};

void print_help() {
    std::puts(
        "kinectlab: a remote laboratory around a Kinect\n\n"
        "Usage: kinectlab COMMAND [ARGUMENTS]\n\nCommands:"
    );
    for (const auto& command : kCommands)
        std::printf("  %-9s %s\n", command.name, command.summary);
    std::puts(
        "\n`kinectlab COMMAND --help` tells the arguments of a command, --version the version.\n"
        "Results go to stdout, messages to stderr; exit 0: done, 1: failed, 2: wrong arguments."
    );
}

int unknown(const std::string& word) {
    std::vector<std::string> names;
    for (const auto& command : kCommands)
        names.emplace_back(command.name);
    std::fprintf(
        stderr,
        "command: \"%s\" is not known; %s; `kinectlab --help` tells what they do\n",
        word.substr(0, 60).c_str(),
        did_you_mean(word, names).c_str()
    );
    return kUsage;
}

int dispatch(int argc, char** argv) {
    const std::string word = argc > 1 ? argv[1] : "";
    if (word.empty()) {
        std::fputs("command: none given; `kinectlab --help` lists all\n", stderr);
        return kUsage;
    }
    if (word == "--help" || word == "-h" || word == "help") return print_help(), kOk;
    if (word == "--version") return std::printf("kinectlab %s\n", config::version()), kOk;
    const auto command = std::find_if(
        std::begin(kCommands), std::end(kCommands), [&](const auto& c) { return word == c.name; }
    );
    if (command == std::end(kCommands)) return unknown(word);
    return command->run(argc - 1, argv + 1);
}

}  // namespace

int run(int argc, char** argv) {
    try {
        const int status = dispatch(argc, argv);
        if (std::fflush(stdout) == 0) return status;
        std::perror("kinectlab: cannot write the result");
        return kFailed;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "kinectlab: %s\n", problem.what());
        return kFailed;
    }
}

}  // namespace kinectlab::commands
