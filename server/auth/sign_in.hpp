#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <variant>

#include "pipeline/core/error.hpp"
#include "server/auth/throttle.hpp"
#include "server/lab/people.hpp"
#include "server/store/store.hpp"

namespace kinectlab::auth {

constexpr TimeNs kSessionIdle = 12 * 3600 * kNsPerSecond;  ///< without a request
constexpr TimeNs kSessionLife = 7 * 86400 * kNsPerSecond;  ///< however much it is used

/// Who asks, as the session says.
struct Identity {
    lab::User user;
    std::string csrf_token;
    std::string token_hash;
};

struct SignedIn {
    Identity identity;
    std::string token;  ///< for the cookie; kept nowhere else
};
struct WrongPassword {};
struct TooManyAttempts {
    TimeNs wait = 0;
};

/// Sessions on the server's side: the cookie is a random token of which only a hash is stored.
/// Thread-safe.
class SignIn {
public:
    explicit SignIn(store::Store& store) : store_(store) {}

    /// An unknown name and a wrong password look the same, in answer and in time.
    [[nodiscard]] std::variant<SignedIn, WrongPassword, TooManyAttempts> sign_in(
        const std::string& username,
        const std::string& password,
        const std::string& address,
        TimeNs now
    );

    /// Whose cookie it is; using a session moves its end.
    [[nodiscard]] std::optional<Identity> identify(const std::string& token, TimeNs now);

    /// Whether this session is there and not over; asking does not move its end.
    [[nodiscard]] bool is_open(const std::string& token_hash, TimeNs now);

    void sign_out(const Identity& identity);

    /// Ends all sessions of this person and opens a new one. Errors name `current` or `new`; wrong
    /// current passwords are throttled like wrong ones at the door (error `unavailable`).
    [[nodiscard]] Result<SignedIn> change_password(
        const Identity& identity,
        const std::string& current,
        const std::string& replacement,
        const std::string& address,
        TimeNs now
    );

private:
    SignedIn open_session(lab::User user, TimeNs now);
    std::optional<TimeNs> attempt(
        const std::string& account, const std::string& address, TimeNs now
    );
    void forgive(const std::string& account, const std::string& address);

    store::Store& store_;
    std::mutex mutex_;
    SignInThrottle throttle_;
};

}  // namespace kinectlab::auth
