#include "server/auth/throttle.hpp"

#include <algorithm>

namespace kinectlab::auth {
namespace {

struct Allowance {
    int places;
    TimeNs refill;  ///< for one place
};

constexpr Allowance kPair{5, 30 * kNsPerSecond};
constexpr Allowance kAccount{50, 10 * kNsPerSecond};
constexpr Allowance kAddress{100, 1 * kNsPerSecond};
constexpr std::size_t kMostBuckets = 20'000;
constexpr std::size_t kMostKnown = 20'000;

using Buckets = std::map<std::string, TimeNs>;

TimeNs full_again(const Buckets& buckets, const std::string& key, TimeNs now) {
    const auto found = buckets.find(key);
    return found == buckets.end() ? now : std::max(found->second, now);
}

/// Time until the bucket has a place.
TimeNs time_to_place(
    const Buckets& buckets, const std::string& key, const Allowance& allowance, TimeNs now
) {
    const TimeNs owed = full_again(buckets, key, now) - now;
    return owed - (allowance.places - 1) * allowance.refill;
}

void take(Buckets& buckets, const std::string& key, const Allowance& allowance, TimeNs now) {
    buckets[key] = full_again(buckets, key, now) + allowance.refill;
    if (buckets.size() <= kMostBuckets) return;
    std::erase_if(buckets, [&](const auto& bucket) { return bucket.second <= now; });
    while (buckets.size() > kMostBuckets) {
        // Somebody tries very many names: the buckets that are nearly full lose least.
        const auto least = std::min_element(buckets.begin(), buckets.end(), [](auto& a, auto& b) {
            return a.second < b.second;
        });
        buckets.erase(least);
    }
}

std::string pair_key(const std::string& account, const std::string& address) {
    return address + ' ' + account;
}

}  // namespace

std::optional<TimeNs> SignInThrottle::wait(
    const std::string& account, const std::string& address, TimeNs now
) const {
    TimeNs longest = time_to_place(by_pair_, pair_key(account, address), kPair, now);
    if (!known_.contains({account, address})) {
        longest = std::max(longest, time_to_place(by_account_, account, kAccount, now));
        longest = std::max(longest, time_to_place(by_address_, address, kAddress, now));
    }
    if (longest <= 0) return std::nullopt;
    return longest;
}

void SignInThrottle::failed(const std::string& account, const std::string& address, TimeNs now) {
    take(by_pair_, pair_key(account, address), kPair, now);
    take(by_account_, account, kAccount, now);
    take(by_address_, address, kAddress, now);
}

void SignInThrottle::succeeded(const std::string& account, const std::string& address) {
    by_pair_.erase(pair_key(account, address));
    if (known_.size() < kMostKnown) known_.insert({account, address});
}

std::size_t SignInThrottle::size() const {
    return by_pair_.size() + by_account_.size() + by_address_.size();
}

}  // namespace kinectlab::auth
