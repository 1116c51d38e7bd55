#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/core/error.hpp"
#include "server/lab/booking.hpp"
#include "server/lab/people.hpp"

namespace kinectlab::lab {

using RunId = std::int64_t;

/// preparing → ready → releasing → measuring → analysing → completed; every state before the last
/// may also become aborted (a person or a time limit), failed (the rig or the analysis) or
/// interrupted (the server went away).
enum class RunState : std::uint8_t {
    preparing,
    ready,
    releasing,
    measuring,
    analysing,
    completed,
    aborted,
    failed,
    interrupted,
};

enum class RunEvent : std::uint8_t {
    prepared,           ///< the bob is held at its angle, the reference is learned
    release_commanded,  ///< a person said go
    released,           ///< the actuator confirmed it: frames count from here
    measured,           ///< the duration is over, or a person stopped it
    analysed,           ///< the result is stored
    abort,
    fail,
    interrupt,
};

[[nodiscard]] std::string_view to_text(RunState state);
[[nodiscard]] std::optional<RunState> run_state_from_text(std::string_view text);
[[nodiscard]] std::string_view to_text(RunEvent event);

/// The one machine of a run. Error conflict where the event does not fit the state.
[[nodiscard]] Result<RunState> next(RunState state, RunEvent event);

[[nodiscard]] constexpr bool is_final(RunState state) {
    return state >= RunState::completed;
}

using Parameters = std::map<std::string, double>;

/// One execution of an experiment on a rig.
struct Run {
    RunId id = 0;
    std::string rig;
    std::string experiment;
    UserId user = 0;
    std::string user_name;  ///< the display name of `user`, filled in when read back
    BookingId booking = 0;
    RunState state = RunState::preparing;
    std::string reason;  ///< why it was aborted, failed or interrupted; empty otherwise
    Parameters parameters;
    std::string definition_json;  ///< the experiment as it was defined when the run began
    double duration_s = 0.0;      ///< how long it is to measure
    TimeNs created = 0;
    std::optional<TimeNs> release_until;  ///< a run that is ready is given up then
    std::optional<TimeNs> started;        ///< released: the first moment that counts
    std::optional<TimeNs> ended;          ///< reached a final state
    std::int64_t frames = 0;              ///< seen while measuring
    std::int64_t frames_lost = 0;         ///< gaps in the device's frame counter while measuring
    std::string result_json;  ///< the newest result object as JSON; empty if there is none
    std::vector<std::string> warnings;  ///< of that result, for a student
};

/// One row of a run's history.
struct RunChange {
    RunId run = 0;
    TimeNs at = 0;
    RunState state = RunState::preparing;
    std::string cause;             ///< a sentence
    std::optional<UserId> person;  ///< who caused it; none where it was the rig or the server
};

}  // namespace kinectlab::lab
