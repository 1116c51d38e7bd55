#pragma once

#include "server/api/context.hpp"
#include "server/net/message.hpp"

namespace kinectlab::api {

/// One request that passed the route table's rules: a person with the right role, and the CSRF
/// token where something changes.
struct Call {
    const Context& context;
    const net::Request& request;
    const auth::Identity& who;  ///< empty on routes for anybody
    TimeNs now = 0;

    [[nodiscard]] const lab::User& user() const { return who.user; }
    /// What {name} in the route's pattern matched.
    [[nodiscard]] const std::string& parameter(const char* name) const {
        return request.parameters.at(name);
    }
};

}  // namespace kinectlab::api
