#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace kinectlab::simulated_rig {

/// Pulls devices' plugs and puts them back in later, from a thread of its own: a program that asks
/// for it must not be called back from inside its own call.
class Plugs {
public:
    using Tell = std::function<void(const std::string& uri, bool plugged_in)>;

    explicit Plugs(Tell tell);
    Plugs(const Plugs&) = delete;
    Plugs& operator=(const Plugs&) = delete;
    ~Plugs();  ///< what is still out stays out

    /// May be called from any thread; returns at once.
    void pull(const std::string& uri, std::chrono::duration<double> out_for);

private:
    using Clock = std::chrono::steady_clock;
    struct Move {
        std::string uri;
        bool plugged_in;
    };
    void run();

    const Tell tell_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool stopping_ = false;
    std::multimap<Clock::time_point, Move> moves_;
    std::thread thread_;
};

}  // namespace kinectlab::simulated_rig
