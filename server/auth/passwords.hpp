#pragma once

#include <string>
#include <string_view>

#include "pipeline/core/error.hpp"

namespace kinectlab::auth {

/// argon2id with 64 MiB and 3 passes, about 100 ms on one core; at most two run at once, the others
/// wait, so that a flood of sign-ins cannot eat the memory. Thread-safe.
[[nodiscard]] std::string hash_password(std::string_view password);
[[nodiscard]] bool verify_password(const std::string& hash, std::string_view password);

/// Takes as long as verify_password, so that the time does not tell whether an account exists.
void verify_against_nobody(std::string_view password);

/// From 10 to 200 bytes, not the user name, not one of the few that everybody tries first.
/// Errors name `field`.
[[nodiscard]] Result<void> check_new_password(
    std::string_view password, std::string_view username, const std::string& field
);

/// 80 random bits that a person can type: "k7wq-p3xm-…", without letters that look alike.
[[nodiscard]] std::string make_one_time_password();

}  // namespace kinectlab::auth
