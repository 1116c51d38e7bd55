#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/bench/measurements.hpp"

namespace kinectlab::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kSeconds = 30.0;

/// The real program beside this one, quietly; the processor time that it took, s.
double run_program(std::vector<std::string> words) {
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "kinectlab";
    words.insert(words.begin(), "kinectlab");
    std::vector<char*> arguments;
    for (auto& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
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
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

}  // namespace

Figures measure_frames_speed() {
    std::string folder = (fs::temp_directory_path() / "kinectlab-bench-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("cannot make a folder");
    const std::string recording = folder + "/run";
    run_program({"simulate", "pendulum", "--out", recording, "--seconds", "30"});
    const double took = run_program({"analyse", "pendulum", recording});
    fs::remove_all(folder);
    return {
        {"analyse a run of 30 s from its frames, times real time",
         kSeconds / took,
         "1",
         10.0,
         Better::higher,
         {},
         {}}};
}

}  // namespace kinectlab::bench
