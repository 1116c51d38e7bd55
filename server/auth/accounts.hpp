#pragma once

#include <optional>
#include <string>

#include "pipeline/core/error.hpp"
#include "server/lab/people.hpp"
#include "server/store/users.hpp"

namespace kinectlab::auth {

/// An account whose password is shown once and has to be replaced at the first sign-in.
struct NewAccount {
    lab::User user;
    std::string one_time_password;
};

/// User names are 2 to 32 of a-z, 0-9, dot, dash, underscore and begin with a letter; display names
/// 1 to 64 characters. Errors name `username` or `display_name`.
[[nodiscard]] Result<void> check_names(
    const std::string& username, const std::string& display_name
);

/// Errors as of check_names(); conflict if the name is taken.
[[nodiscard]] Result<NewAccount> add_account(
    store::UserRepository& users,
    const std::string& username,
    const std::string& display_name,
    lab::Role role,
    TimeNs now
);

/// A new one-time password; ends all sessions of that person. Error not_found.
[[nodiscard]] Result<NewAccount> reset_password(
    store::UserRepository& users, const std::string& username
);

/// An administrator, if there is none yet: the first start of a laboratory. The account is "admin",
/// or "admin-2" and so on where somebody else has that name.
[[nodiscard]] std::optional<NewAccount> add_first_admin(store::UserRepository& users, TimeNs now);

}  // namespace kinectlab::auth
