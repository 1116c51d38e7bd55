#include "server/api/wire.hpp"

#include <nlohmann/json.hpp>

#include "server/experiments/poses_csv.hpp"
#include "server/lab/permissions.hpp"
#include "server/lab/utc.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

json time_or_null(const std::optional<TimeNs>& time) {
    return time ? json(lab::to_rfc3339(*time)) : json(nullptr);
}

/// Five decimals, 10 µm: below what any of our sensors resolves.
json rounded(double value) {
    return std::isfinite(value) ? json(std::round(value * 1e5) / 1e5) : json(nullptr);
}

}  // namespace

json to_json(const lab::User& user) {
    return {
        {"id", user.id},
        {"username", user.username},
        {"display_name", user.display_name},
        {"role", lab::to_text(user.role)},
        {"must_change_password", user.must_change_password}};
}

json session_json(const auth::Identity& identity) {
    return {{"user", to_json(identity.user)}, {"csrf_token", identity.csrf_token}};
}

json to_json(const auth::NewAccount& account) {
    return {{"user", to_json(account.user)}, {"one_time_password", account.one_time_password}};
}

json to_json(const lab::RigStatus& rig) {
    return {
        {"id", rig.id},
        {"name", rig.name},
        {"state", lab::to_text(rig.state)},
        {"sentence", rig.sentence},
        {"simulated", rig.simulated},
        {"experiments", rig.experiments},
        {"frame_rate_hz", std::round(rig.frame_rate_hz * 100) / 100},
        {"frames_lost", rig.frames_lost},
        {"current_run", rig.current_run ? json(*rig.current_run) : json(nullptr)}};
}

json to_json(const lab::Slot& slot) {
    return {
        {"rig", slot.rig},
        {"start", lab::to_rfc3339(slot.start)},
        {"end", lab::to_rfc3339(slot.end)}};
}

json entry_json(const rig::LibraryEntry& entry, const lab::User& viewer) {
    json document = experiments::to_json(entry.definition);
    document["state"] = rig::to_text(entry.state);
    document["version"] = entry.version ? json(*entry.version) : json(nullptr);
    document["owner"] = entry.owner ? json(entry.owner_name) : json(nullptr);
    document["mine"] = entry.owner == viewer.id;
    return document;
}

json booking_json(const lab::Booking& booking, const lab::User& viewer) {
    json document = to_json(booking.slot);
    document["id"] = booking.id;
    document["experiment"] = booking.experiment;
    document["mine"] = booking.user == viewer.id;
    document["user"] = lab::may_see_name(viewer, booking) ? json(booking.user_name) : json(nullptr);
    return document;
}

json to_json(const lab::Run& run) {
    const bool waits = run.state == lab::RunState::ready;
    return {
        {"id", run.id},
        {"rig", run.rig},
        {"experiment", run.experiment},
        {"user", run.user_name},
        {"state", lab::to_text(run.state)},
        {"reason", run.reason},
        {"parameters", run.parameters},
        {"created_at", lab::to_rfc3339(run.created)},
        {"release_until", time_or_null(waits ? run.release_until : std::nullopt)},
        {"started_at", time_or_null(run.started)},
        {"ended_at", time_or_null(run.ended)},
        {"duration_s", run.duration_s},
        {"frames", run.frames},
        {"frames_lost", run.frames_lost},
        {"result", run.result_json.empty() ? json(nullptr) : json::parse(run.result_json)},
        {"warnings", run.warnings}};
}

json columns_json(const Trajectory& trajectory, TimeNs zero) {
    json columns = {{"object", trajectory.object}};
    for (const char* name : {"t_s", "status", "x", "y", "z", "vx", "vy", "vz"})
        columns[name] = json::array();
    for (const MotionSample& sample : trajectory.samples) {
        columns["t_s"].push_back(std::round(to_seconds(sample.t - zero) * 1e6) / 1e6);
        columns["status"].push_back(experiments::to_text(sample.status));
        columns["x"].push_back(rounded(sample.p_lab.x()));
        columns["y"].push_back(rounded(sample.p_lab.y()));
        columns["z"].push_back(rounded(sample.p_lab.z()));
        columns["vx"].push_back(rounded(sample.v_lab.x()));
        columns["vy"].push_back(rounded(sample.v_lab.y()));
        columns["vz"].push_back(rounded(sample.v_lab.z()));
    }
    return columns;
}

net::Response json_response(int status, const json& body) {
    net::Response response;
    response.status = status;
    response.content_type = "application/json";
    response.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
    response.headers = {{"Cache-Control", "no-store"}};
    return response;
}

net::Response no_content() {
    return {204, "", "", {{"Cache-Control", "no-store"}}};
}

}  // namespace kinectlab::api
