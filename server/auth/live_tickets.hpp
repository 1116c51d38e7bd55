#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "server/lab/people.hpp"

namespace kinectlab::auth {

constexpr TimeNs kTicketLife = 30 * kNsPerSecond;

/// What opens a WebSocket: a browser cannot put a token into a header there, and a URL may be
/// logged on its way. So a ticket is good once, for 30 s, for one rig. Thread-safe, in memory only.
class LiveTickets {
public:
    struct Ticket {
        std::string token;
        TimeNs expires = 0;
    };

    /// Who opens a stream, and with which session: the stream ends with it.
    struct Holder {
        lab::UserId user = 0;
        std::string session;  ///< the hash of its token
    };

    [[nodiscard]] Ticket issue(const Holder& holder, const std::string& rig, TimeNs now);

    /// Whose ticket it is; nothing if it is unknown, used, expired or for another rig. Uses it up
    /// in any case. Whether the session is still open is for the caller to ask.
    [[nodiscard]] std::optional<Holder> redeem(
        const std::string& token, const std::string& rig, TimeNs now
    );

private:
    struct Entry {
        Holder holder;
        std::string rig;
        TimeNs expires = 0;
    };
    std::mutex mutex_;
    std::map<std::string, Entry> by_hash_;
};

}  // namespace kinectlab::auth
