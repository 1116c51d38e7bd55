#include <set>

#include <gtest/gtest.h>

#include "server/auth/live_tickets.hpp"
#include "server/auth/passwords.hpp"
#include "server/auth/tokens.hpp"

namespace kinectlab::auth {
namespace {

constexpr TimeNs kNow = 1'800'000'000 * kNsPerSecond;

TEST(Passwords, VerifyOnlyThemselves) {
    const std::string hash = hash_password("correct horse");
    EXPECT_TRUE(hash.starts_with("$argon2id$v=19$m=65536,t=3,"));
    EXPECT_TRUE(verify_password(hash, "correct horse"));
    EXPECT_FALSE(verify_password(hash, "correct hors"));
    EXPECT_FALSE(verify_password("no hash", "correct horse"));
    EXPECT_NE(hash_password("correct horse"), hash) << "salted";
}

TEST(Passwords, WeakOnesAreRefused) {
    for (const char* weak : {"", "short", "password123", "ada12345678"})
        EXPECT_EQ(check_new_password(weak, "ada", "new").error().field, "new") << weak;
    EXPECT_FALSE(check_new_password(std::string(201, 'x'), "ada", "new"));
    EXPECT_TRUE(check_new_password("a few words in a row", "ada", "new"));
}

TEST(Passwords, OneTimeOnesAreReadableAndDiffer) {
    std::set<std::string> seen;
    for (int i = 0; i < 200; ++i)
        EXPECT_TRUE(seen.insert(make_one_time_password()).second);
    EXPECT_EQ(seen.begin()->size(), 19U);
    EXPECT_EQ(seen.begin()->find_first_of("l1o0"), std::string::npos);
}

TEST(Tokens, AreLongAndNeverStoredAsTheyAre) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 43U);
    EXPECT_NE(token, make_token());
    EXPECT_NE(hash_token(token), token);
    EXPECT_EQ(hash_token(token), hash_token(token));
    EXPECT_TRUE(same_secret(token, token));
    EXPECT_FALSE(same_secret(token, token.substr(1)));
    EXPECT_FALSE(same_secret("", "x"));
}

TEST(LiveTickets, AreGoodOnceForTheirRigAndForHalfAMinute) {
    LiveTickets tickets;
    const auto ticket = tickets.issue({7, "session"}, "rig-1", kNow);
    EXPECT_EQ(ticket.expires, kNow + kTicketLife);
    const auto holder = tickets.redeem(ticket.token, "rig-1", kNow + 1);
    ASSERT_TRUE(holder);
    EXPECT_EQ(holder->user, 7);
    EXPECT_EQ(holder->session, "session");
    EXPECT_FALSE(tickets.redeem(ticket.token, "rig-1", kNow + 2));

    const auto other = tickets.issue({7, "session"}, "rig-1", kNow);
    EXPECT_FALSE(tickets.redeem(other.token, "rig-2", kNow));
    EXPECT_FALSE(tickets.redeem(other.token, "rig-1", kNow)) << "used up by the wrong rig";

    const auto old = tickets.issue({7, "session"}, "rig-1", kNow);
    EXPECT_FALSE(tickets.redeem(old.token, "rig-1", kNow + kTicketLife));
    EXPECT_FALSE(tickets.redeem("", "rig-1", kNow));
}

}  // namespace
}  // namespace kinectlab::auth
