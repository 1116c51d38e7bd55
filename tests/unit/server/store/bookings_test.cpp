#include <atomic>
#include <barrier>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::store {
namespace {

using test::kMinute;
using test::kNoon;
using test::TemporaryStore;

TEST(Bookings, AreReadBackAsTheyWereMade) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    const auto made = store.add_booking(ada, kNoon, kNoon + 30 * kMinute);
    const auto found = store->bookings.find(made.id);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->slot, (lab::Slot{"rig-1", kNoon, kNoon + 30 * kMinute}));
    EXPECT_EQ(found->user, ada.id);
    EXPECT_EQ(found->user_name, "Display ada");
    EXPECT_EQ(found->experiment, "pendulum");
    EXPECT_EQ(found->created, kNoon);
}

TEST(Bookings, ATakenSlotIsAConflictWithAlternatives) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    const auto bob = store.add_user("bob");
    store.add_booking(ada, kNoon, kNoon + 30 * kMinute);
    const lab::Slot wanted{"rig-1", kNoon + 10 * kMinute, kNoon + 20 * kMinute};
    const auto refused = store->bookings.add({bob.id, bob.role, "pendulum", wanted}, kNoon);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::conflict);
    const auto offered = store->bookings.alternatives(wanted, {"rig-1", "rig-2"}, kNoon);
    ASSERT_EQ(offered.size(), 3U);
    EXPECT_EQ(offered[0], (lab::Slot{"rig-2", wanted.start, wanted.end}));
    for (const auto& slot : offered) {
        EXPECT_TRUE(store->bookings.add({bob.id, bob.role, "pendulum", slot}, kNoon));
    }
}

TEST(Bookings, AreListedByRigAndPersonAndTime) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    store.add_booking(ada, kNoon, kNoon + 30 * kMinute);
    store.add_booking(ada, kNoon + 60 * kMinute, kNoon + 90 * kMinute);
    const auto on_rig = [&](TimeNs from, TimeNs to) {
        return store->bookings.on_rig("rig-1", from, to).size();
    };
    EXPECT_EQ(on_rig(kNoon, kNoon + 90 * kMinute), 2U);
    EXPECT_EQ(on_rig(kNoon + 30 * kMinute, kNoon + 60 * kMinute), 0U);
    EXPECT_EQ(on_rig(kNoon + 29 * kMinute, kNoon + 60 * kMinute), 1U);
    EXPECT_EQ(store->bookings.of_user(ada.id, kNoon + 30 * kMinute).size(), 1U);
    EXPECT_TRUE(store->bookings.at("rig-1", kNoon));
    EXPECT_FALSE(store->bookings.at("rig-1", kNoon + 30 * kMinute));
    EXPECT_FALSE(store->bookings.at("rig-2", kNoon));
}

TEST(Bookings, ACancelledSlotIsFreeAgain) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    const auto made = store.add_booking(ada, kNoon, kNoon + 30 * kMinute);
    EXPECT_TRUE(store->bookings.cancel(made.id, kNoon));
    EXPECT_EQ(store->bookings.cancel(made.id, kNoon).error().code, ErrorCode::not_found);
    EXPECT_TRUE(store->bookings.of_user(ada.id, 0).empty());
    store.add_booking(ada, kNoon, kNoon + 30 * kMinute);
}

TEST(Bookings, ARunUnderWayKeepsItsBooking) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    const auto made = store.add_booking(ada, kNoon, kNoon + 30 * kMinute);
    const auto run = store.add_run(made);
    EXPECT_EQ(store->bookings.cancel(made.id, kNoon).error().code, ErrorCode::conflict);
    ASSERT_TRUE(store->runs.advance(run.id, {lab::RunEvent::abort, kNoon, "enough", ada.id}));
    EXPECT_TRUE(store->bookings.cancel(made.id, kNoon));
}

TEST(Bookings, TheDatabaseItselfRefusesAnOverlap) {
    TemporaryStore store;
    const auto ada = store.add_user("ada");
    store.add_booking(ada, kNoon, kNoon + 30 * kMinute);
    const auto other = store.add_booking(ada, kNoon + 60 * kMinute, kNoon + 90 * kMinute);
    Database::Transaction transaction(store->database);
    const std::string insert =
        "INSERT INTO bookings (rig, experiment, user_id, start_ns, end_ns, created_ns) VALUES "
        "('rig-1', 'pendulum', 1, ";
    const auto slot = [](TimeNs start, TimeNs end) {
        return std::to_string(start) + ", " + std::to_string(end) + ", 0)";
    };
    EXPECT_THROW(
        transaction.connection().exec(insert + slot(kNoon + 25 * kMinute, kNoon + 35 * kMinute)),
        SQLite::Exception
    );
    EXPECT_THROW(
        transaction.connection().exec(
            "UPDATE bookings SET start_ns = " + std::to_string(kNoon + 25 * kMinute) +
            " WHERE id = " + std::to_string(other.id)
        ),
        SQLite::Exception
    );
    transaction.connection().exec(insert + slot(kNoon + 30 * kMinute, kNoon + 35 * kMinute));
}

TEST(Bookings, OfManyWhoRaceForASlotExactlyOneWins) {
    TemporaryStore store;
    constexpr int kRacers = 8;
    std::vector<lab::User> racers;
    for (int i = 0; i < kRacers; ++i)
        racers.push_back(store.add_user("racer" + std::to_string(i)));
    // A second opening of the same file races too, as another process would.
    const auto second = store.open();
    for (int round = 0; round < 10; ++round) {
        const lab::Slot slot{
            "rig-1", kNoon + round * 30 * kMinute, kNoon + (round + 1) * 30 * kMinute};
        std::barrier start(kRacers);
        std::atomic<int> won{0};
        std::atomic<int> conflicts{0};
        std::vector<std::thread> threads;
        for (int i = 0; i < kRacers; ++i) {
            threads.emplace_back([&, i] {
                auto& bookings = i % 2 == 0 ? store->bookings : second->bookings;
                start.arrive_and_wait();
                const auto result =
                    bookings.add({racers[i].id, lab::Role::assistant, "pendulum", slot}, kNoon);
                (result ? won : conflicts)++;
                if (!result) {
                    EXPECT_EQ(result.error().code, ErrorCode::conflict);
                }
            });
        }
        for (auto& thread : threads)
            thread.join();
        EXPECT_EQ(won, 1);
        EXPECT_EQ(conflicts, kRacers - 1);
    }
}

}  // namespace
}  // namespace kinectlab::store
