#include "server/auth/throttle.hpp"

#include <gtest/gtest.h>

namespace kinectlab::auth {
namespace {

constexpr TimeNs kNow = 1'800'000'000 * kNsPerSecond;
constexpr TimeNs kSecond = kNsPerSecond;

/// Attempts that got through of `count` wrong ones made at once.
int guesses(
    SignInThrottle& throttle, const std::string& account, const std::string& address, int count
) {
    int through = 0;
    for (int i = 0; i < count; ++i) {
        if (throttle.wait(account, address, kNow)) continue;
        throttle.failed(account, address, kNow);
        ++through;
    }
    return through;
}

TEST(SignInThrottle, FiveFreeThenOneEveryHalfMinute) {
    SignInThrottle throttle;
    EXPECT_EQ(guesses(throttle, "ada", "1.1.1.1", 100), 5);
    EXPECT_EQ(throttle.wait("ada", "1.1.1.1", kNow), 30 * kSecond);
    EXPECT_FALSE(throttle.wait("ada", "1.1.1.1", kNow + 30 * kSecond));
    EXPECT_FALSE(throttle.wait("bob", "1.1.1.1", kNow)) << "others are not concerned";
}

TEST(SignInThrottle, ManyAddressesDoNotHelpAgainstOneAccount) {
    SignInThrottle throttle;
    int through = 0;
    for (int i = 0; i < 1000; ++i)
        through += guesses(throttle, "ada", "10.0.0." + std::to_string(i), 5);
    EXPECT_EQ(through, 50);
}

TEST(SignInThrottle, ManyAccountsDoNotHelpFromOneAddress) {
    SignInThrottle throttle;
    int through = 0;
    for (int i = 0; i < 1000; ++i)
        through += guesses(throttle, "user" + std::to_string(i), "1.1.1.1", 5);
    EXPECT_EQ(through, 100);
}

TEST(SignInThrottle, AnAttackDoesNotLockItsVictimOut) {
    SignInThrottle throttle;
    throttle.succeeded("ada", "home");
    for (int i = 0; i < 10'000; ++i)
        guesses(throttle, "ada", "bot" + std::to_string(i), 1);
    EXPECT_TRUE(throttle.wait("ada", "elsewhere", kNow));
    EXPECT_FALSE(throttle.wait("ada", "home", kNow));
}

TEST(SignInThrottle, SuccessForgivesAndMemoryIsBounded) {
    SignInThrottle throttle;
    guesses(throttle, "ada", "home", 4);
    throttle.succeeded("ada", "home");
    EXPECT_EQ(guesses(throttle, "ada", "home", 100), 5);
    for (int i = 0; i < 21'000; ++i)
        throttle.failed("user" + std::to_string(i), "net", kNow + i * kSecond);
    EXPECT_LE(throttle.size(), 60'000U);
}

}  // namespace
}  // namespace kinectlab::auth
