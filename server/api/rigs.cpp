#include <nlohmann/json.hpp>

#include "server/api/body.hpp"
#include "server/api/problem.hpp"
#include "server/api/resources.hpp"
#include "server/api/wire.hpp"

namespace kinectlab::api {
namespace {

using nlohmann::json;

constexpr TimeNs kDay = 86400 * kNsPerSecond;
constexpr TimeNs kLongestList = 62 * kDay;

net::Response no_such_rig(const std::string& rig) {
    return problem(
        404, "there is no rig '" + rig.substr(0, 40) + "'", "choose one from the list of rigs"
    );
}

}  // namespace

net::Response get_rigs(const Call& call) {
    json rigs = json::array();
    for (const auto& rig : call.context.rigs.list(call.now))
        rigs.push_back(to_json(rig));
    return json_response(200, {{"rigs", rigs}});
}

net::Response get_rig(const Call& call) {
    const auto rig = call.context.rigs.find(call.parameter("rig"), call.now);
    return rig ? json_response(200, to_json(*rig)) : no_such_rig(call.parameter("rig"));
}

net::Response get_camera_picture(const Call& call) {
    const auto picture = call.context.rigs.picture(call.parameter("rig"));
    if (!picture && picture.error().code == ErrorCode::not_found) {
        return no_such_rig(call.parameter("rig"));
    }
    if (!picture) return to_response(picture.error());
    const auto packet = call.context.jpegs.packet(*picture);
    return {
        200,
        "image/jpeg",
        packet->substr(live::JpegCache::kHeaderBytes),
        {{"Cache-Control", "no-store"}}};
}

net::Response get_rig_bookings(const Call& call) {
    const std::string& rig = call.parameter("rig");
    if (!call.context.rigs.find(rig, call.now)) return no_such_rig(rig);
    if (auto ok = check_query(call.request, {"from", "to"}); !ok) return to_response(ok.error());
    const auto from = query_time(call.request, "from");
    if (!from) return to_response(from.error());
    const auto to = query_time(call.request, "to");
    if (!to) return to_response(to.error());
    const TimeNs first = from->value_or(call.now);
    const TimeNs last = to->value_or(first + 7 * kDay);
    if (last <= first || last - first > kLongestList) {
        const Error error{
            ErrorCode::invalid_argument,
            "to",
            "is not after `from`, or more than 62 days after it",
            "give a later time, at most 62 days later"};
        return to_response(error);
    }
    json bookings = json::array();
    for (const auto& booking : call.context.store.bookings.on_rig(rig, first, last))
        bookings.push_back(booking_json(booking, call.user()));
    return json_response(200, {{"bookings", bookings}});
}

}  // namespace kinectlab::api
