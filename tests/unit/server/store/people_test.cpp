#include <gtest/gtest.h>

#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::store {
namespace {

using test::kMinute;
using test::kNoon;
using test::TemporaryStore;

TEST(Users, AreKeptAndFoundWhateverTheCaseOfTheirName) {
    TemporaryStore store;
    const auto ada = store->users.add(
        {"Ada", "Ada Lovelace", lab::Role::instructor, "$argon2id$hash", true}, kNoon
    );
    ASSERT_TRUE(ada);
    const auto found = store->users.credentials("aDA");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->user.id, ada->id);
    EXPECT_EQ(found->user.role, lab::Role::instructor);
    EXPECT_TRUE(found->user.must_change_password);
    EXPECT_EQ(found->user.created, kNoon);
    EXPECT_EQ(found->password_hash, "$argon2id$hash");
    EXPECT_FALSE(store->users.credentials("bob"));
    EXPECT_FALSE(store->users.find(ada->id + 1));
}

TEST(Users, ATakenNameIsAConflict) {
    TemporaryStore store;
    store.add_user("ada");
    const auto again =
        store->users.add({"ADA", "Another", lab::Role::student, "$argon2id$x", true}, kNoon);
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().code, ErrorCode::conflict);
    EXPECT_EQ(again.error().field, "username");
    EXPECT_EQ(store->users.all().size(), 1U);
}

TEST(Users, ANameIsNeverTakenForSql) {
    TemporaryStore store;
    store.add_user("ada");
    EXPECT_FALSE(store->users.credentials("' OR 1=1 --"));
    store.add_user("'); DROP TABLE users; --");
    EXPECT_EQ(store->users.all().size(), 2U);
}

TEST(Users, APasswordThatWasNotHashedIsNeverStored) {
    TemporaryStore store;
    EXPECT_ANY_THROW((void
    )store->users.add({"ada", "Ada", lab::Role::student, "secret", true}, kNoon));
    EXPECT_TRUE(store->users.all().empty());
}

TEST(Users, ANewPasswordEndsAllSessions) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    store->sessions.add({"hash", "csrf", ada.id, kNoon, kNoon + kMinute});
    store->users.set_password(ada.id, "$argon2id$new", false);
    EXPECT_FALSE(store->sessions.find("hash", kNoon));
    EXPECT_EQ(store->users.credentials(ada.id)->password_hash, "$argon2id$new");
}

TEST(Sessions, EndAtTheirTime) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    store->sessions.add({"hash", "csrf", ada.id, kNoon, kNoon + kMinute});
    EXPECT_EQ(store->sessions.find("hash", kNoon)->csrf_token, "csrf");
    EXPECT_FALSE(store->sessions.find("hash", kNoon + kMinute));
    EXPECT_FALSE(store->sessions.find("other", kNoon));
    store->sessions.extend("hash", kNoon + 2 * kMinute);
    EXPECT_TRUE(store->sessions.find("hash", kNoon + kMinute));
    store->sessions.remove_expired(kNoon + 2 * kMinute);
    EXPECT_FALSE(store->sessions.find("hash", kNoon));
}

TEST(Sessions, AreRemovedOneByOneOrAllOfAPerson) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    for (const char* hash : {"a", "b", "c"}) {
        store->sessions.add({hash, "csrf", ada.id, kNoon, kNoon + kMinute});
    }
    store->sessions.remove("a");
    EXPECT_FALSE(store->sessions.find("a", kNoon));
    EXPECT_TRUE(store->sessions.find("b", kNoon));
    store->sessions.remove_all_of(ada.id);
    EXPECT_FALSE(store->sessions.find("b", kNoon));
}

}  // namespace
}  // namespace kinectlab::store
