#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pipeline/core/time.hpp"

namespace kinectlab::lab {

using UserId = std::int64_t;

/// Each role has the rights of those before it.
enum class Role : std::uint8_t { student, assistant, instructor, staff, admin };

[[nodiscard]] constexpr bool at_least(Role have, Role needed) {
    return have >= needed;
}
[[nodiscard]] std::string_view to_text(Role role);
[[nodiscard]] std::optional<Role> role_from_text(std::string_view text);

/// A person with an account; the password's hash never leaves server/store and server/auth.
struct User {
    UserId id = 0;
    std::string username;      ///< unique, signs in with it
    std::string display_name;  ///< what others read
    Role role = Role::student;
    bool must_change_password = false;  ///< true until a one-time password is replaced
    TimeNs created = 0;
};

}  // namespace kinectlab::lab
