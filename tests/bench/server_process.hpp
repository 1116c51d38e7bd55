#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <sys/types.h>

namespace kinectlab::bench {

/// The real program beside this one, serving on a free port with a data folder that goes away.
class ServerProcess {
public:
    /// Throws if it does not come up.
    ServerProcess();
    ~ServerProcess();
    ServerProcess(const ServerProcess&) = delete;
    ServerProcess& operator=(const ServerProcess&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] const std::string& one_time_password() const { return password_; }

private:
    std::filesystem::path folder_;
    pid_t pid_ = -1;
    std::uint16_t port_ = 0;
    std::string password_;
};

}  // namespace kinectlab::bench
