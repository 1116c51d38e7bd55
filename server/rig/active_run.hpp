#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "server/bus/bus.hpp"
#include "server/lab/run.hpp"
#include "server/store/store.hpp"

namespace kinectlab::rig {

/// The run that a rig is busy with, as it stands in the store. People (through the HTTP side) and
/// the rig's worker both take it further; whoever comes second finds that it no longer fits.
/// Thread-safe.
class ActiveRun {
public:
    ActiveRun(store::Store& store, bus::Bus& bus) : store_(store), bus_(bus) {}

    void begin(const lab::Run& run);
    [[nodiscard]] std::optional<lab::Run> current() const;

    /// Stores the change, then tells the bus. Errors: conflict where the event does not fit or no
    /// run is under way.
    Result<lab::Run> advance(const store::RunStep& step);

    /// The same for a command that must be meant for this very run.
    Result<lab::Run> advance(lab::RunId id, const store::RunStep& step);

    /// Stores a result and completes the run, both or neither.
    Result<lab::Run> complete(const store::StoredResult& result, const store::RunStep& step);

    /// Stores how many frames the measurement has seen and missed, and tells the bus.
    void set_frames(std::int64_t frames, std::int64_t lost);

    /// The rig is free again.
    void clear();

private:
    Result<lab::Run> advance_locked(const store::RunStep& step);
    void reread_and_publish(lab::RunId id);

    store::Store& store_;
    bus::Bus& bus_;
    mutable std::mutex mutex_;
    std::optional<lab::Run> run_;
};

}  // namespace kinectlab::rig
