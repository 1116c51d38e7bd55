#include "server/lab/people.hpp"

#include <algorithm>
#include <array>

namespace kinectlab::lab {
namespace {

constexpr std::array<std::string_view, 5> kRoles{
    "student", "assistant", "instructor", "staff", "admin"};

}  // namespace

std::string_view to_text(Role role) {
    return kRoles.at(static_cast<std::size_t>(role));
}

std::optional<Role> role_from_text(std::string_view text) {
    const auto* found = std::find(kRoles.begin(), kRoles.end(), text);
    if (found == kRoles.end()) return std::nullopt;
    return static_cast<Role>(found - kRoles.begin());
}

}  // namespace kinectlab::lab
