#pragma once

#include <optional>
#include <string>

#include "server/lab/people.hpp"
#include "server/store/database.hpp"

namespace kinectlab::store {

struct Session {
    std::string token_hash;  ///< of the cookie's token; the token itself is never stored
    std::string csrf_token;
    lab::UserId user = 0;
    TimeNs created = 0;
    TimeNs expires = 0;
};

/// Who is signed in.
class SessionRepository {
public:
    explicit SessionRepository(Database& database) : database_(database) {}

    void add(const Session& session);
    /// Nothing if it is unknown or expired at `now`.
    [[nodiscard]] std::optional<Session> find(const std::string& token_hash, TimeNs now);
    /// Moves the end of a session, e.g. while it is used.
    void extend(const std::string& token_hash, TimeNs expires);
    void remove(const std::string& token_hash);
    void remove_all_of(lab::UserId user);
    void remove_expired(TimeNs now);

private:
    Database& database_;
};

}  // namespace kinectlab::store
