#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/trajectory.hpp"
#include "server/auth/accounts.hpp"
#include "server/auth/sign_in.hpp"
#include "server/lab/booking.hpp"
#include "server/lab/people.hpp"
#include "server/lab/rig.hpp"
#include "server/lab/run.hpp"
#include "server/net/message.hpp"
#include "server/rig/experiment_library.hpp"

/// How everything looks as JSON, in one place; README.md beside it says the same in words.
namespace kinectlab::api {

[[nodiscard]] nlohmann::json to_json(const lab::User& user);
[[nodiscard]] nlohmann::json session_json(const auth::Identity& identity);
[[nodiscard]] nlohmann::json to_json(const auth::NewAccount& account);
[[nodiscard]] nlohmann::json to_json(const lab::RigStatus& rig);
[[nodiscard]] nlohmann::json to_json(const lab::Slot& slot);
[[nodiscard]] nlohmann::json to_json(const lab::Run& run);

/// The definition with "state", "version", "owner" and "mine".
[[nodiscard]] nlohmann::json entry_json(const rig::LibraryEntry& entry, const lab::User& viewer);

/// As `viewer` may see it: others' names only for assistants and up.
[[nodiscard]] nlohmann::json booking_json(const lab::Booking& booking, const lab::User& viewer);

/// Columns for plots; t_s counts from `zero`. Values of lost poses are null.
[[nodiscard]] nlohmann::json columns_json(const Trajectory& trajectory, TimeNs zero);

/// An answer that nobody may keep.
[[nodiscard]] net::Response json_response(int status, const nlohmann::json& body);
[[nodiscard]] net::Response no_content();

}  // namespace kinectlab::api
