#include "server/auth/accounts.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/auth/passwords.hpp"

namespace kinectlab::auth {
namespace {

bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}

Result<void> check_username(const std::string& username) {
    const auto allowed = [](char c) {
        return is_lower(c) || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
    };
    const bool good = username.size() >= 2 && username.size() <= 32 && is_lower(username.front()) &&
                      std::all_of(username.begin(), username.end(), allowed);
    if (good) return {};
    return fail(
        ErrorCode::invalid_argument,
        "username",
        "is '" + username.substr(0, 40) + "'",
        "give 2 to 32 characters of a-z, 0-9, dot, dash and underscore, beginning with a letter"
    );
}

Result<void> check_display_name(const std::string& name) {
    const auto control = [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    };
    const bool blank = name.find_first_not_of(' ') == std::string::npos;
    const auto letters = std::count_if(name.begin(), name.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;  // not a UTF-8 continuation
    });
    if (!blank && letters <= 64 && std::none_of(name.begin(), name.end(), control)) return {};
    return fail(
        ErrorCode::invalid_argument,
        "display_name",
        blank ? "is empty" : "is too long or has control characters",
        "give 1 to 64 characters on one line"
    );
}

}  // namespace

Result<void> check_names(const std::string& username, const std::string& display_name) {
    if (auto ok = check_username(username); !ok) return ok;
    return check_display_name(display_name);
}

Result<NewAccount> add_account(
    store::UserRepository& users,
    const std::string& username,
    const std::string& display_name,
    lab::Role role,
    TimeNs now
) {
    if (auto ok = check_names(username, display_name); !ok) return tl::unexpected(ok.error());
    std::string password = make_one_time_password();
    store::NewUser record{username, display_name, role, hash_password(password), true};
    auto user = users.add(record, now);
    if (!user) return tl::unexpected(user.error());
    return NewAccount{std::move(*user), std::move(password)};
}

Result<NewAccount> reset_password(store::UserRepository& users, const std::string& username) {
    auto found = users.credentials(username);
    if (!found) {
        return fail(
            ErrorCode::not_found,
            "username",
            "there is no account '" + username.substr(0, 40) + "'",
            "give one that `kinectlab user list` shows"
        );
    }
    std::string password = make_one_time_password();
    users.set_password(found->user.id, hash_password(password), true);
    found->user.must_change_password = true;
    return NewAccount{std::move(found->user), std::move(password)};
}

std::optional<NewAccount> add_first_admin(store::UserRepository& users, TimeNs now) {
    const auto all = users.all();
    const auto is_admin = [](const lab::User& user) {
        return user.role == lab::Role::admin;
    };
    if (std::any_of(all.begin(), all.end(), is_admin)) return std::nullopt;
    const auto taken = [&](const std::string& name) {
        return users.credentials(name).has_value();
    };
    std::string name = "admin";
    for (int i = 2; taken(name); ++i)
        name = "admin-" + std::to_string(i);
    auto account = add_account(users, name, "Administrator", lab::Role::admin, now);
    if (!account)
        throw std::runtime_error("cannot make the first account: " + to_text(account.error()));
    return std::move(*account);
}

}  // namespace kinectlab::auth
