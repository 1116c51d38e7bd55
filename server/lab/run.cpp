#include "server/lab/run.hpp"

#include <algorithm>
#include <array>

namespace kinectlab::lab {
namespace {

constexpr std::array<std::string_view, 9> kStates{
    "preparing",
    "ready",
    "releasing",
    "measuring",
    "analysing",
    "completed",
    "aborted",
    "failed",
    "interrupted"};

constexpr std::array<std::string_view, 8> kEvents{
    "prepared", "release", "released", "stop", "analysed", "abort", "fail", "interrupt"};

struct Edge {
    RunState from;
    RunEvent event;
    RunState to;
};

constexpr std::array<Edge, 5> kWay{{
    {RunState::preparing, RunEvent::prepared, RunState::ready},
    {RunState::ready, RunEvent::release_commanded, RunState::releasing},
    {RunState::releasing, RunEvent::released, RunState::measuring},
    {RunState::measuring, RunEvent::measured, RunState::analysing},
    {RunState::analysing, RunEvent::analysed, RunState::completed},
}};

/// Where an event leads from every state that is not final; nothing for the events on the way.
std::optional<RunState> way_out(RunEvent event) {
    if (event == RunEvent::abort) return RunState::aborted;
    if (event == RunEvent::fail) return RunState::failed;
    if (event == RunEvent::interrupt) return RunState::interrupted;
    return std::nullopt;
}

}  // namespace

std::string_view to_text(RunState state) {
    return kStates.at(static_cast<std::size_t>(state));
}

std::optional<RunState> run_state_from_text(std::string_view text) {
    const auto* found = std::find(kStates.begin(), kStates.end(), text);
    if (found == kStates.end()) return std::nullopt;
    return static_cast<RunState>(found - kStates.begin());
}

std::string_view to_text(RunEvent event) {
    return kEvents.at(static_cast<std::size_t>(event));
}

Result<RunState> next(RunState state, RunEvent event) {
    if (is_final(state)) {
        return fail(
            ErrorCode::conflict,
            "state",
            "the run is over: " + std::string(to_text(state)),
            "start a new run"
        );
    }
    if (const auto out = way_out(event)) return *out;

    const auto* edge = std::find_if(kWay.begin(), kWay.end(), [&](const Edge& candidate) {
        return candidate.event == event;
    });
    if (edge->from != state) {
        return fail(
            ErrorCode::conflict,
            "state",
            "the run is " + std::string(to_text(state)) + ": " + std::string(to_text(event)) +
                " does not fit",
            "wait until it is " + std::string(to_text(edge->from))
        );
    }
    return edge->to;
}

}  // namespace kinectlab::lab
