#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>

#include "server/bus/bus.hpp"

namespace kinectlab::bus {

/// What waits for one reader; see Subscription for what happens when it is full. Thread-safe.
class Queue {
public:
    explicit Queue(SubscriptionSettings settings) : settings_(std::move(settings)) {}

    void push(const std::shared_ptr<const Event>& event);
    [[nodiscard]] std::optional<Delivery> pop(std::chrono::milliseconds timeout);
    [[nodiscard]] std::uint64_t dropped() const;

    /// Takes nothing more and wakes nobody more.
    void close();

private:
    template <class Kind>
    void make_room(std::size_t limit, Delivery& newest);
    void forget_older_status(const RigChanged& newest);

    const SubscriptionSettings settings_;
    mutable std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<Delivery> waiting_;
    std::uint64_t dropped_ = 0;
    bool closed_ = false;
};

}  // namespace kinectlab::bus
