#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/bus/events.hpp"

namespace kinectlab::bus {

struct SubscriptionSettings {
    std::string rig;             ///< only events of this rig; empty: of all rigs
    std::size_t poses = 256;     ///< poses that wait at most; then the oldest waiting makes room
    std::size_t pictures = 2;    ///< pictures that wait at most; then the oldest waiting makes room
    std::function<void()> wake;  ///< called by the publisher's thread when the queue was empty and
                                 ///< no longer is; must be quick and must not call the bus
};

/// One event, shared by all who read it.
struct Delivery {
    std::shared_ptr<const Event> event;
    std::uint32_t dropped = 0;  ///< events of the same kind that made room since the one before
};

/// Events that wait for one reader, in the order of publication. Poses and pictures are bounded,
/// the newest win and the loss is counted. Changes of runs and rigs are never lost; where the
/// reader sleeps, only the newest status of each rig waits. Destroying it ends the subscription:
/// after that `wake` is not called any more.
class Subscription {
public:
    virtual ~Subscription() = default;
    Subscription(const Subscription&) = delete;
    Subscription& operator=(const Subscription&) = delete;

    [[nodiscard]] virtual std::optional<Delivery> try_next() = 0;

    /// Waits for the next event; nothing if none came in time.
    [[nodiscard]] virtual std::optional<Delivery> next(std::chrono::milliseconds timeout) = 0;

    /// Poses and pictures that made room so far.
    [[nodiscard]] virtual std::uint64_t dropped() const = 0;

protected:
    Subscription() = default;
};

/// Carries events from the rig workers to everybody else in this process. Thread-safe; publish()
/// never waits for a reader.
class Bus {
public:
    Bus();
    ~Bus();
    Bus(const Bus&) = delete;
    Bus& operator=(const Bus&) = delete;

    void publish(Event event);
    [[nodiscard]] std::unique_ptr<Subscription> subscribe(SubscriptionSettings settings);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::bus
