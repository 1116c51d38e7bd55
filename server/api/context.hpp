#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "server/auth/live_sessions.hpp"
#include "server/auth/live_tickets.hpp"
#include "server/auth/sign_in.hpp"
#include "server/live/hub.hpp"
#include "server/live/jpeg.hpp"
#include "server/rig/experiment_library.hpp"
#include "server/rig/rig_service.hpp"
#include "server/store/store.hpp"

namespace kinectlab::api {

/// What the resources work with. Each part is thread-safe; the context itself never changes.
struct Context {
    store::Store& store;
    rig::RigService& rigs;
    live::Hub& hub;
    live::JpegCache& jpegs;
    auth::SignIn& sign_in;
    auth::LiveTickets& tickets;
    auth::LiveSessions& live_sessions;
    rig::ExperimentLibrary& library;
    std::filesystem::path description;        ///< openapi.json
    std::filesystem::path definition_schema;  ///< experiment.schema.json
    std::function<TimeNs()> now;
};

}  // namespace kinectlab::api
