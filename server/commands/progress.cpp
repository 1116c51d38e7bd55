#include "server/commands/progress.hpp"

#include <cstdio>

#include <unistd.h>

namespace kinectlab::commands {
namespace {

using namespace std::chrono_literals;

constexpr auto kOnTerminal = 200ms;
constexpr auto kElsewhere = 5s;

}  // namespace

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(std::chrono::steady_clock::now() + (terminal_ ? kOnTerminal : kElsewhere)) {}

Progress::~Progress() {
    if (terminal_ && printed_) std::fputs("\r\033[K", stderr);
}

void Progress::step() {
    ++done_;
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = now + (terminal_ ? kOnTerminal : kElsewhere);
    print();
}

void Progress::print() {
    printed_ = true;
    std::string text = what_ + ": " + std::to_string(done_);
    if (done_ <= total_) text += " of " + std::to_string(total_);
    std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
}

}  // namespace kinectlab::commands
