#include "server/auth/live_tickets.hpp"

#include <algorithm>

#include "server/auth/tokens.hpp"

namespace kinectlab::auth {
namespace {

/// Of one person; more than this waits for nobody.
constexpr std::ptrdiff_t kMostOfOne = 32;

}  // namespace

LiveTickets::Ticket LiveTickets::issue(const Holder& holder, const std::string& rig, TimeNs now) {
    Ticket ticket{make_token(), now + kTicketLife};
    const std::lock_guard lock(mutex_);
    std::erase_if(by_hash_, [&](const auto& entry) { return entry.second.expires <= now; });
    const auto mine = [&](const auto& entry) {
        return entry.second.holder.user == holder.user;
    };
    if (std::count_if(by_hash_.begin(), by_hash_.end(), mine) >= kMostOfOne) {
        std::erase_if(by_hash_, mine);
    }
    by_hash_[hash_token(ticket.token)] = {holder, rig, ticket.expires};
    return ticket;
}

std::optional<LiveTickets::Holder> LiveTickets::redeem(
    const std::string& token, const std::string& rig, TimeNs now
) {
    const std::lock_guard lock(mutex_);
    const auto found = by_hash_.find(hash_token(token));
    if (found == by_hash_.end()) return std::nullopt;
    Entry entry = std::move(found->second);
    by_hash_.erase(found);
    if (entry.rig != rig || entry.expires <= now) return std::nullopt;
    return std::move(entry.holder);
}

}  // namespace kinectlab::auth
