#include "pipeline/drivers/simulated_rig/plugs.hpp"

#include <utility>

namespace kinectlab::simulated_rig {

Plugs::Plugs(Tell tell) : tell_(std::move(tell)), thread_([this] { run(); }) {}

Plugs::~Plugs() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Plugs::pull(const std::string& uri, std::chrono::duration<double> out_for) {
    const auto now = Clock::now();
    {
        const std::lock_guard lock(mutex_);
        moves_.emplace(now, Move{uri, false});
        moves_.emplace(now + std::chrono::duration_cast<Clock::duration>(out_for), Move{uri, true});
    }
    changed_.notify_all();
}

void Plugs::run() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        if (moves_.empty()) {
            changed_.wait(lock);
        } else if (const auto due = moves_.begin()->first; Clock::now() < due) {
            changed_.wait_until(lock, due);
        } else {
            const Move move = moves_.extract(moves_.begin()).mapped();
            lock.unlock();
            tell_(move.uri, move.plugged_in);
            lock.lock();
        }
    }
}

}  // namespace kinectlab::simulated_rig
