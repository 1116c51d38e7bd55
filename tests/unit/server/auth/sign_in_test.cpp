#include "server/auth/sign_in.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "server/auth/accounts.hpp"

namespace kinectlab::auth {
namespace {

namespace fs = std::filesystem;
constexpr TimeNs kNow = 1'800'000'000 * kNsPerSecond;
constexpr TimeNs kHour = 3600 * kNsPerSecond;

class SignInTest : public testing::Test {
protected:
    SignInTest()
        : folder_(make_folder()),
          store_(folder_ / "db", fs::path(KINECTLAB_SOURCE_DIR) / "migrations") {}
    ~SignInTest() override { fs::remove_all(folder_); }

    static fs::path make_folder() {
        std::string name = (fs::temp_directory_path() / "kinectlab-auth-XXXXXX").string();
        return mkdtemp(name.data());
    }
    SignedIn enter(const NewAccount& account) {
        return std::get<SignedIn>(
            door_.sign_in(account.user.username, account.one_time_password, "here", kNow)
        );
    }

    fs::path folder_;
    store::Store store_;
    SignIn door_{store_};
};

TEST_F(SignInTest, TheFirstAdminIsMadeOnce) {
    const auto first = add_first_admin(store_.users, kNow);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->user.role, lab::Role::admin);
    EXPECT_TRUE(first->user.must_change_password);
    EXPECT_FALSE(add_first_admin(store_.users, kNow));
}

TEST_F(SignInTest, ThereIsAnAdminWhoeverWasAddedBefore) {
    ASSERT_TRUE(add_account(store_.users, "alice", "Alice", lab::Role::student, kNow));
    ASSERT_TRUE(add_account(store_.users, "admin", "Not one", lab::Role::staff, kNow));
    const auto first = add_first_admin(store_.users, kNow);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->user.username, "admin-2");
    EXPECT_EQ(first->user.role, lab::Role::admin);
    EXPECT_EQ(enter(*first).identity.user.username, "admin-2");
    EXPECT_FALSE(add_first_admin(store_.users, kNow));
}

TEST_F(SignInTest, SessionsEndWhenIdleAndInAnyCaseAfterAWeek) {
    const auto session = enter(*add_first_admin(store_.users, kNow));
    EXPECT_TRUE(door_.identify(session.token, kNow + 11 * kHour));
    EXPECT_FALSE(door_.identify(session.token, kNow + 11 * kHour + kSessionIdle + kHour));

    const auto used = enter(*reset_password(store_.users, "admin"));
    TimeNs t = kNow;
    while (t < kNow + kSessionLife - kHour) {
        ASSERT_TRUE(door_.identify(used.token, t));
        t += 6 * kHour;
    }
    EXPECT_FALSE(door_.identify(used.token, kNow + kSessionLife));
}

TEST_F(SignInTest, ANewPasswordEndsAllOtherSessions) {
    const auto account = *add_first_admin(store_.users, kNow);
    const auto elsewhere = enter(account);
    const auto here = enter(account);
    const auto changed = door_.change_password(
        here.identity, account.one_time_password, "a new long one", "here", kNow
    );
    ASSERT_TRUE(changed);
    EXPECT_FALSE(door_.identify(elsewhere.token, kNow));
    EXPECT_FALSE(door_.identify(here.token, kNow));
    const auto who = door_.identify(changed->token, kNow);
    ASSERT_TRUE(who);
    EXPECT_FALSE(who->user.must_change_password);
}

TEST_F(SignInTest, WrongOnesLookTheSameAndAreCounted) {
    const auto account = *add_first_admin(store_.users, kNow);
    for (int i = 0; i < 5; ++i) {
        const auto answer = door_.sign_in("admin", "wrong", "there", kNow);
        EXPECT_TRUE(std::holds_alternative<WrongPassword>(answer));
    }
    const auto refused = door_.sign_in("Admin", account.one_time_password, "there", kNow);
    EXPECT_TRUE(std::holds_alternative<TooManyAttempts>(refused));
    const auto unknown = door_.sign_in("nobody", "wrong", "there", kNow);
    EXPECT_TRUE(std::holds_alternative<WrongPassword>(unknown));
}

TEST_F(SignInTest, NamesAreChecked) {
    for (const char* name : {"", "a", "A", "1abc", "a b", "a'b"})
        EXPECT_EQ(
            add_account(store_.users, name, "Name", lab::Role::student, kNow).error().field,
            "username"
        ) << name;
    for (const char* name : {"", "  ", "a\nb", "\x7f"})
        EXPECT_EQ(
            add_account(store_.users, "ada", name, lab::Role::student, kNow).error().field,
            "display_name"
        );
    EXPECT_TRUE(store_.users.all().empty());
}

}  // namespace
}  // namespace kinectlab::auth
