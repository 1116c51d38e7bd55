#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "server/lab/people.hpp"
#include "server/store/database.hpp"

namespace kinectlab::store {

struct NewUser {
    std::string username;
    std::string display_name;
    lab::Role role = lab::Role::student;
    std::string password_hash;  ///< argon2id, as libsodium writes it
    bool must_change_password = true;
};

struct Credentials {
    lab::User user;
    std::string password_hash;
};

/// People with accounts. User names are compared without regard to ASCII case.
class UserRepository {
public:
    explicit UserRepository(Database& database) : database_(database) {}

    /// Error conflict on `username` if it is taken.
    [[nodiscard]] Result<lab::User> add(const NewUser& user, TimeNs now);
    [[nodiscard]] std::optional<lab::User> find(lab::UserId id);
    [[nodiscard]] std::optional<Credentials> credentials(const std::string& username);
    [[nodiscard]] std::optional<Credentials> credentials(lab::UserId id);
    /// Also ends every session of this person: a new password locks out who knew the old one.
    void set_password(lab::UserId id, const std::string& password_hash, bool must_change);
    [[nodiscard]] std::vector<lab::User> all();

private:
    Database& database_;
};

}  // namespace kinectlab::store
