#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pipeline/analysis/median.hpp"
#include "tests/bench/measurements.hpp"

namespace kinectlab::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kSeconds = 30.0;
constexpr int kRuns = 3;

/// What a run of the program took, s.
struct Took {
    double wall;
    double processor;  ///< of all its threads
};

/// The real program beside this one, quietly.
Took run_program(std::vector<std::string> words) {
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "kinectlab";
    words.insert(words.begin(), "kinectlab");
    std::vector<char*> arguments;
    for (auto& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const auto begin = std::chrono::steady_clock::now();
    const pid_t pid = fork();
    if (pid < 0) throw std::runtime_error("cannot start the program");
    if (pid == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        execv(program.c_str(), arguments.data());
        _exit(127);
    }
    int status = 0;
    rusage used{};
    if (wait4(pid, &status, 0, &used) != pid || status != 0)
        throw std::runtime_error("kinectlab " + words[1] + " failed");
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return {wall.count(), seconds(used.ru_utime) + seconds(used.ru_stime)};
}

}  // namespace

Figures measure_frames_speed() {
    std::string folder = (fs::temp_directory_path() / "kinectlab-bench-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("cannot make a folder");
    const std::string recording = folder + "/run";
    run_program({"simulate", "pendulum", "--out", recording, "--seconds", "30"});
    std::vector<double> wall, processor;
    for (int i = 0; i < kRuns; ++i) {
        const Took took = run_program({"analyse", "pendulum", recording});
        wall.push_back(took.wall);
        processor.push_back(took.processor);
    }
    fs::remove_all(folder);
    return {
        {"analyse a run of 30 s from its frames, times real time",
         kSeconds / median(wall),
         "1",
         10.0,
         Better::higher,
         {},
         {}},
        {"analyse a run of 30 s from its frames, times real time on one core",
         kSeconds / median(processor),
         "1",
         {},
         Better::higher,
         {},
         {}}};
}

}  // namespace kinectlab::bench
