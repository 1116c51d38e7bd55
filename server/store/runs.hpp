#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "server/lab/run.hpp"
#include "server/store/database.hpp"

namespace kinectlab::store {

struct RunFilter {
    std::optional<lab::UserId> user;
    std::optional<std::string> rig;
    std::optional<lab::RunId> before;  ///< only older runs, for the next page
    int limit = 50;
};

struct RunStep {
    lab::RunEvent event = lab::RunEvent::prepared;
    TimeNs at = 0;
    std::string cause;  ///< a sentence; becomes the run's reason where it ends without a result
    std::optional<lab::UserId> person;
};

/// Runs and the history of their states.
class RunRepository {
public:
    explicit RunRepository(Database& database) : database_(database) {}

    /// Stores a run in the state preparing; id, state and user_name are filled in. Error conflict
    /// if another run of this rig is not over.
    [[nodiscard]] Result<lab::Run> add(const lab::Run& run);
    /// Takes the run one step on in lab::next() and stores the change with time, cause and person.
    /// Errors: not_found, conflict where the event does not fit the stored state.
    [[nodiscard]] Result<lab::Run> advance(lab::RunId id, const RunStep& step);
    void set_frames(lab::RunId id, std::int64_t frames, std::int64_t lost);
    [[nodiscard]] std::optional<lab::Run> find(lab::RunId id);
    /// Newest first.
    [[nodiscard]] std::vector<lab::Run> list(const RunFilter& filter);
    [[nodiscard]] std::vector<lab::RunChange> history(lab::RunId id);
    /// For the start of the server: what a crash left open (on one rig, or on all) becomes
    /// interrupted; poses are kept. Returns which.
    std::vector<lab::RunId> interrupt_unfinished(
        TimeNs now, const std::string& reason, const std::optional<std::string>& rig = {}
    );

private:
    Database& database_;
};

}  // namespace kinectlab::store
