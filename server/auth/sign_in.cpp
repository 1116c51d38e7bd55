#include "server/auth/sign_in.hpp"

#include <algorithm>

#include "server/auth/passwords.hpp"
#include "server/auth/tokens.hpp"

namespace kinectlab::auth {
namespace {

/// A session's end is written at most this often.
constexpr TimeNs kExtendEvery = 60 * kNsPerSecond;

TimeNs end_of_session(TimeNs created, TimeNs now) {
    return std::min(now + kSessionIdle, created + kSessionLife);
}

/// User names are compared without regard to case, so they are counted that way too.
std::string throttle_key(std::string name) {
    name.resize(std::min<std::size_t>(name.size(), 64));
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return name;
}

}  // namespace

std::optional<TimeNs> SignIn::attempt(
    const std::string& account, const std::string& address, TimeNs now
) {
    const std::lock_guard lock(mutex_);
    const auto wait = throttle_.wait(account, address, now);
    // Counted as wrong until proven right: attempts made at once cannot slip through together.
    if (!wait) throttle_.failed(account, address, now);
    return wait;
}

void SignIn::forgive(const std::string& account, const std::string& address) {
    const std::lock_guard lock(mutex_);
    throttle_.succeeded(account, address);
}

std::variant<SignedIn, WrongPassword, TooManyAttempts> SignIn::sign_in(
    const std::string& username, const std::string& password, const std::string& address, TimeNs now
) {
    const std::string account = throttle_key(username);
    if (const auto wait = attempt(account, address, now)) return TooManyAttempts{*wait};
    auto found = store_.users.credentials(username);
    if (!found) {
        verify_against_nobody(password);
        return WrongPassword{};
    }
    if (!verify_password(found->password_hash, password)) return WrongPassword{};
    forgive(account, address);
    store_.sessions.remove_expired(now);
    return open_session(std::move(found->user), now);
}

SignedIn SignIn::open_session(lab::User user, TimeNs now) {
    SignedIn opened;
    opened.token = make_token();
    opened.identity = {std::move(user), make_token(), hash_token(opened.token)};
    store::Session session;
    session.token_hash = opened.identity.token_hash;
    session.csrf_token = opened.identity.csrf_token;
    session.user = opened.identity.user.id;
    session.created = now;
    session.expires = end_of_session(now, now);
    store_.sessions.add(session);
    return opened;
}

std::optional<Identity> SignIn::identify(const std::string& token, TimeNs now) {
    auto session = store_.sessions.find(hash_token(token), now);
    if (!session) return std::nullopt;
    auto user = store_.users.find(session->user);
    if (!user) return std::nullopt;
    const TimeNs end = end_of_session(session->created, now);
    if (end > session->expires + kExtendEvery) store_.sessions.extend(session->token_hash, end);
    return Identity{
        std::move(*user), std::move(session->csrf_token), std::move(session->token_hash)};
}

bool SignIn::is_open(const std::string& token_hash, TimeNs now) {
    return store_.sessions.find(token_hash, now).has_value();
}

void SignIn::sign_out(const Identity& identity) {
    store_.sessions.remove(identity.token_hash);
}

Result<SignedIn> SignIn::change_password(
    const Identity& identity,
    const std::string& current,
    const std::string& replacement,
    const std::string& address,
    TimeNs now
) {
    const std::string account = throttle_key(identity.user.username);
    if (auto ok = check_new_password(replacement, identity.user.username, "new"); !ok) {
        return tl::unexpected(ok.error());
    }
    if (replacement == current) {
        return fail(
            ErrorCode::invalid_argument, "new", "is the same as before", "choose a different one"
        );
    }
    if (const auto wait = attempt(account, address, now)) {
        return fail(
            ErrorCode::unavailable,
            "current",
            "was wrong too often",
            "try again in " + std::to_string(*wait / kNsPerSecond + 1) + " seconds"
        );
    }
    const auto found = store_.users.credentials(identity.user.id);
    if (!found || !verify_password(found->password_hash, current)) {
        return fail(
            ErrorCode::invalid_argument,
            "current",
            "is wrong",
            "give the password you signed in with"
        );
    }
    forgive(account, address);
    store_.users.set_password(identity.user.id, hash_password(replacement), false);
    lab::User user = identity.user;
    user.must_change_password = false;
    return open_session(std::move(user), now);
}

}  // namespace kinectlab::auth
