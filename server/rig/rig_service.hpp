#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "server/bus/bus.hpp"
#include "server/lab/people.hpp"
#include "server/lab/rig.hpp"
#include "server/lab/run.hpp"
#include "server/rig/experiment_library.hpp"
#include "server/rig/rig_settings.hpp"
#include "server/store/store.hpp"

namespace kinectlab::rig {

struct RunRequest {
    std::string rig;
    std::string experiment;
    lab::Parameters parameters;  ///< what is left out takes the definition's default
};

/// All rigs of this process. Thread-safe; no call waits for a rig, only for the disk.
class RigService {
public:
    /// Marks runs that a crash left open as interrupted, then starts one worker for each rig. A rig
    /// whose device is not there is offline, and tried again. Library, store and bus must outlive
    /// it.
    RigService(
        const std::vector<RigSettings>& rigs,
        const ExperimentLibrary& library,
        store::Store& store,
        bus::Bus& bus
    );
    ~RigService();  ///< shutdown()
    RigService(const RigService&) = delete;
    RigService& operator=(const RigService&) = delete;

    [[nodiscard]] std::vector<lab::RigStatus> list(TimeNs now) const;
    [[nodiscard]] std::optional<lab::RigStatus> find(const std::string& rig, TimeNs now) const;

    /// Errors: not_found (rig, experiment), invalid_argument (`parameters.NAME`), forbidden or
    /// conflict (no booking of this person now, too late in the slot, another run under way),
    /// unavailable (the rig is offline). The run it returns is stored and prepares itself.
    [[nodiscard]] Result<lab::Run> start_run(
        const lab::User& user, const RunRequest& request, TimeNs now
    );
    /// Errors of these three: not_found, forbidden, conflict in the wrong state. The change is
    /// stored when they return, and acted on with the rig's next frame.
    [[nodiscard]] Result<lab::Run> release(const lab::User& user, lab::RunId run, TimeNs now);
    [[nodiscard]] Result<lab::Run> stop(const lab::User& user, lab::RunId run, TimeNs now);
    [[nodiscard]] Result<lab::Run> abort(const lab::User& user, lab::RunId run, TimeNs now);

    /// The newest colour picture; error not_found (rig) or unavailable (none yet, or offline).
    [[nodiscard]] Result<bus::PictureTaken> picture(const std::string& rig) const;

    /// Interrupts what is under way, stops every bob and ends the workers. May be called twice.
    void shutdown();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::rig
