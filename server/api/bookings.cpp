#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"
#include "server/lab/permissions.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

/// Rigs that can do the experiment, the wanted one first.
std::vector<std::string> rigs_for(const Call& call, const std::string& experiment) {
    std::vector<std::string> rigs;
    for (const auto& rig : call.context.rigs.list(call.now)) {
        const auto& can = rig.experiments;
        if (std::find(can.begin(), can.end(), experiment) != can.end()) rigs.push_back(rig.id);
    }
    return rigs;
}

Result<void> check_rig(const Call& call, const std::string& rig, const std::string& experiment) {
    const auto status = call.context.rigs.find(rig, call.now);
    if (!status) {
        return fail(
            ErrorCode::invalid_argument,
            "rig",
            fmt::format("there is no rig '{}'", rig.substr(0, 40)),
            "give one that GET /api/v1/rigs lists"
        );
    }
    const auto& can = status->experiments;
    if (std::find(can.begin(), can.end(), experiment) != can.end()) return {};
    return fail(
        ErrorCode::invalid_argument,
        "experiment",
        fmt::format("'{}' is not possible on this rig", experiment.substr(0, 40)),
        "give one of the rig's experiments"
    );
}

net::Response no_such_booking() {
    return problem(404, "there is no such booking");
}

}  // namespace

net::Response get_bookings(const Call& call) {
    json bookings = json::array();
    for (const auto& booking : call.context.store.bookings.of_user(call.user().id, call.now))
        bookings.push_back(booking_json(booking, call.user()));
    return json_response(200, {{"bookings", bookings}});
}

net::Response post_booking(const Call& call) {
    const auto body = read_body(call.request);
    if (!body) return to_response(body.error());
    ObjectReader reader(*body, "", {"rig", "experiment", "start", "end"});
    lab::BookingRequest wish;
    wish.user = call.user().id;
    wish.role = call.user().role;
    wish.slot.rig = reader.text("rig");
    wish.experiment = reader.text("experiment");
    wish.slot.start = read_time(reader, "start");
    wish.slot.end = read_time(reader, "end");
    if (!reader.ok()) return to_response(reader.error().value());
    if (auto ok = check_rig(call, wish.slot.rig, wish.experiment); !ok) {
        return to_response(ok.error());
    }
    auto& bookings = call.context.store.bookings;
    const auto booking = bookings.add(wish, call.now);
    if (booking) return json_response(201, booking_json(*booking, call.user()));
    if (booking.error().code != ErrorCode::conflict) return to_response(booking.error());
    json alternatives = json::array();
    const auto rigs = rigs_for(call, wish.experiment);
    for (const auto& slot : bookings.alternatives(wish.slot, rigs, call.now))
        alternatives.push_back(to_json(slot));
    return to_response(409, booking.error(), {{"alternatives", alternatives}});
}

net::Response delete_booking(const Call& call) {
    auto& bookings = call.context.store.bookings;
    const auto id = parse_id(call.parameter("booking"));
    const auto booking = id ? bookings.find(*id) : std::nullopt;
    if (!booking) return no_such_booking();
    if (auto ok = lab::may_cancel_booking(call.user(), *booking, call.now); !ok) {
        return to_response(ok.error());
    }
    if (auto ok = bookings.cancel(*id, call.now); !ok) return to_response(ok.error());
    return no_content();
}

}  // namespace kinectlab::api
