#include "tests/bench/server_process.hpp"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <poll.h>

namespace kinectlab::bench {
namespace {

namespace fs = std::filesystem;

fs::path make_folder() {
    std::string name = (fs::temp_directory_path() / "kinectlab-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder");
    return name;
}

/// One rig is enough, and leaves the other core to the client.
fs::path write_config(const fs::path& folder) {
    const fs::path file = folder / "config.json";
    std::ofstream(file) << R"({"listen":"127.0.0.1:0","data_dir":".","log_level":"warn",)"
                        << R"("rigs":[{"id":"rig-1","uri":"sim://rig-1?seed=1"}]})";
    return file;
}

pid_t start(const fs::path& program, const fs::path& config, int out) {
    const pid_t pid = fork();
    if (pid < 0) throw std::runtime_error("cannot start the server");
    if (pid > 0) return pid;
    dup2(out, STDOUT_FILENO);
    execl(program.c_str(), "kinectlab", "serve", "--config", config.c_str(), nullptr);
    _exit(127);
}

/// Until `wanted` matches; throws after 30 s or when the server ends.
std::smatch read_until(int in, const std::regex& wanted, std::string& text) {
    std::smatch match;
    while (!std::regex_search(text, match, wanted)) {
        pollfd waiting{in, POLLIN, 0};
        char part[512];
        const bool there = poll(&waiting, 1, 30'000) > 0;
        const ssize_t count = there ? read(in, part, sizeof part) : 0;
        if (count <= 0) throw std::runtime_error("the server did not come up: " + text);
        text.append(part, static_cast<std::size_t>(count));
    }
    return match;
}

}  // namespace

ServerProcess::ServerProcess() : folder_(make_folder()) {
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "kinectlab";
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
    pid_ = start(program, write_config(folder_), ends[1]);
    close(ends[1]);
    std::string text;
    const std::regex ready(R"(ready: http://\S+:(\d+)\n[^\n]*one-time password (\S+))");
    const auto match = read_until(ends[0], ready, text);
    port_ = static_cast<std::uint16_t>(std::stoi(match[1]));
    password_ = match[2];
    close(ends[0]);
}

ServerProcess::~ServerProcess() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

}  // namespace kinectlab::bench
