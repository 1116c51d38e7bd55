#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace kinectlab::commands {

/// Tells on stderr how far a command has come: on a terminal in one line that is written over, else
/// in a line every five seconds.
class Progress {
public:
    /// `total` may be an estimate: beyond it no end is told any more.
    Progress(std::string what, std::size_t total);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    /// One more is done.
    void step();

private:
    void print();

    std::string what_;
    std::size_t total_;
    std::size_t done_ = 0;
    bool terminal_;
    bool printed_ = false;
    std::chrono::steady_clock::time_point next_;
};

}  // namespace kinectlab::commands
