#pragma once

#include <span>

namespace kinectlab::commands {

/// One word of the command line: `kinectlab NAME …`.
struct Command {
    const char* name;
    const char* summary;
    int (*run)(int argc, char** argv);  ///< argv[0] is the command's name; returns the exit status
};

constexpr int kOk = 0;
constexpr int kFailed = 1;  ///< it was tried and did not work
constexpr int kUsage = 2;   ///< what was asked for makes no sense

/// Finds the command that argv[1] names and runs it; the only place that catches everything.
int run(int argc, char** argv);

int serve(int argc, char** argv);
int simulate(int argc, char** argv);
int track(int argc, char** argv);
int analyse(int argc, char** argv);
int user(int argc, char** argv);

}  // namespace kinectlab::commands
