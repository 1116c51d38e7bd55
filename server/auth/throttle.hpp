#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "pipeline/core/time.hpp"

namespace kinectlab::auth {

/// Slows down who guesses passwords. Every wrong one takes a place in three buckets that refill
/// with time: of this account from this address (5, one back every 30 s), of the account from
/// anywhere (50, one every 10 s) and of the address for any account (100, one a second). An account
/// that signed in from an address before is bound there by the first bucket only, so that an attack
/// on it, or from its network, does not lock its owner out. Not thread-safe; time is passed in.
class SignInThrottle {
public:
    /// How long to wait before the next attempt; nothing if it may be made now.
    [[nodiscard]] std::optional<TimeNs> wait(
        const std::string& account, const std::string& address, TimeNs now
    ) const;
    void failed(const std::string& account, const std::string& address, TimeNs now);
    void succeeded(const std::string& account, const std::string& address);

    /// Buckets in memory; those that are full again are forgotten, and there are never more than a
    /// few tens of thousands.
    [[nodiscard]] std::size_t size() const;

private:
    /// The bucket as the one time at which it will be full again (GCRA).
    using Buckets = std::map<std::string, TimeNs>;
    using Pair = std::pair<std::string, std::string>;

    Buckets by_pair_;
    Buckets by_account_;
    Buckets by_address_;
    std::set<Pair> known_;
};

}  // namespace kinectlab::auth
