#include "server/lab/booking.hpp"

#include <random>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kinectlab::lab {
namespace {

constexpr TimeNs kMinute = 60 * kNsPerSecond;
constexpr TimeNs kBlock = 5 * kMinute;
constexpr TimeNs kNow = 1'795'338'180 * kNsPerSecond;  // 2026-11-22T09:03:00Z
constexpr TimeNs kNine = kNow - 3 * kMinute;

BookingRequest request(TimeNs start, TimeNs end, UserId user = 1) {
    return {.user = user, .experiment = "pendulum", .slot = {"rig-1", start, end}};
}

Booking booking(TimeNs start, TimeNs end, UserId user = 2, const std::string& rig = "rig-1") {
    return {.user = user, .experiment = "pendulum", .slot = {rig, start, end}};
}

std::string refused_field(const BookingRequest& wish, const std::vector<Booking>& existing = {}) {
    const auto result = check_booking(wish, existing, kNow);
    return result ? "" : result.error().field;
}

TEST(CheckBooking, TakesASlotOnWholeFiveMinutes) {
    EXPECT_TRUE(check_booking(request(kNine + kBlock, kNine + 2 * kBlock), {}, kNow));
    EXPECT_EQ(refused_field(request(kNine + kMinute, kNine + 2 * kBlock)), "start");
    EXPECT_EQ(refused_field(request(kNine + kBlock, kNine + 2 * kBlock + 1)), "end");
}

TEST(CheckBooking, TakesTheBlockThatHasBegunButNothingEarlier) {
    EXPECT_TRUE(check_booking(request(kNine, kNine + 6 * kBlock), {}, kNow));
    EXPECT_EQ(refused_field(request(kNine - kBlock, kNine + 6 * kBlock)), "start");
}

TEST(CheckBooking, BoundsLengthAndHorizon) {
    EXPECT_TRUE(check_booking(request(kNine, kNine + 24 * kBlock), {}, kNow));
    EXPECT_EQ(refused_field(request(kNine, kNine + 25 * kBlock)), "end");
    EXPECT_EQ(refused_field(request(kNine, kNine)), "end");
    EXPECT_EQ(refused_field(request(kNine + kBlock, kNine)), "end");
    const TimeNs far = kNine + 30 * 24 * 60 * kMinute;
    EXPECT_TRUE(check_booking(request(far - kBlock, far), {}, kNow));
    EXPECT_EQ(refused_field(request(far, far + kBlock)), "end");
}

TEST(CheckBooking, SurvivesTimesAtTheEndsOfTime) {
    const TimeNs first = std::numeric_limits<TimeNs>::min() / kBlock * kBlock;
    const TimeNs last = std::numeric_limits<TimeNs>::max() / kBlock * kBlock;
    EXPECT_EQ(refused_field(request(first, last)), "start");
    EXPECT_EQ(refused_field(request(kNine, last)), "end");
}

TEST(CheckBooking, SlotsAreHalfOpen) {
    const std::vector<Booking> taken{booking(kNine + 2 * kBlock, kNine + 4 * kBlock)};
    EXPECT_TRUE(check_booking(request(kNine + kBlock, kNine + 2 * kBlock), taken, kNow));
    EXPECT_TRUE(check_booking(request(kNine + 4 * kBlock, kNine + 5 * kBlock), taken, kNow));
    const auto refused = check_booking(request(kNine + kBlock, kNine + 3 * kBlock), taken, kNow);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::conflict);
}

TEST(CheckBooking, AnotherRigIsNotInTheWay) {
    const std::vector<Booking> taken{booking(kNine, kNine + 4 * kBlock, 2, "rig-2")};
    EXPECT_TRUE(check_booking(request(kNine, kNine + kBlock), taken, kNow));
}

TEST(CheckBooking, AStudentHoldsFiveAtMost) {
    std::vector<Booking> own;
    for (TimeNs k = 1; k <= 5; ++k) {
        own.push_back(booking(kNine + 2 * k * kBlock, kNine + (2 * k + 1) * kBlock, 1));
    }
    own.push_back(booking(kNine - 2 * kBlock, kNine, 1));  // over: does not count
    BookingRequest sixth = request(kNine + 20 * kBlock, kNine + 21 * kBlock);
    EXPECT_EQ(refused_field(sixth, own), "user");
    sixth.role = Role::assistant;
    EXPECT_EQ(refused_field(sixth, own), "");
    own.erase(own.begin());
    sixth.role = Role::student;
    EXPECT_EQ(refused_field(sixth, own), "");
}

/// A wish that is sometimes wrong in each way that a wish can be wrong.
BookingRequest random_wish(std::mt19937& random, TimeNs now) {
    const auto pick = [&](int from, int to) {
        return std::uniform_int_distribution<int>(from, to)(random);
    };
    const TimeNs start = now / kBlock * kBlock + pick(-3, 60) * kBlock + (pick(0, 9) == 0 ? 1 : 0);
    return {
        .user = pick(1, 30),
        .role = pick(0, 1) == 0 ? Role::student : Role::assistant,
        .experiment = "pendulum",
        .slot = {pick(0, 1) == 0 ? "rig-1" : "rig-2", start, start + pick(-1, 26) * kBlock},
    };
}

RC_GTEST_PROP(BookingProperty, RandomHistoriesNeverOverlap, (unsigned seed)) {
    std::mt19937 random(seed);
    std::vector<Booking> accepted;
    TimeNs now = kNow;
    for (int i = 0; i < 200; ++i) {
        now += std::uniform_int_distribution<TimeNs>(0, 20 * kMinute)(random);
        if (!accepted.empty() && i % 7 == 0) accepted.erase(accepted.begin() + i % accepted.size());
        const BookingRequest wish = random_wish(random, now);
        if (check_booking(wish, accepted, now)) {
            accepted.push_back({.user = wish.user, .experiment = "pendulum", .slot = wish.slot});
        }
    }
    RC_ASSERT(accepted.size() > 3U);
    for (std::size_t a = 0; a < accepted.size(); ++a) {
        for (std::size_t b = a + 1; b < accepted.size(); ++b) {
            // Written out once more, so that a mistake in overlap() does not hide itself.
            const Slot& one = accepted[a].slot;
            const Slot& two = accepted[b].slot;
            RC_ASSERT(one.rig != two.rig || one.end <= two.start || two.end <= one.start);
        }
    }
}

RC_GTEST_PROP(BookingProperty, AlternativesAreAlwaysValidAndDoNotTouchEachOther, (unsigned seed)) {
    std::mt19937 random(seed);
    const std::vector<std::string> rigs{"rig-1", "rig-2"};
    std::vector<Booking> accepted;
    for (int i = 0; i < 60; ++i) {
        const BookingRequest wish = random_wish(random, kNow);
        if (check_booking(wish, accepted, kNow)) {
            accepted.push_back({.user = 99, .experiment = "pendulum", .slot = wish.slot});
        }
    }
    const BookingRequest wish = random_wish(random, kNow);
    const auto offered = alternatives(wish.slot, rigs, accepted, kNow, 4);
    for (const Slot& slot : offered) {
        BookingRequest instead = wish;
        instead.slot = slot;
        RC_ASSERT(check_booking(instead, accepted, kNow).has_value());
        RC_ASSERT(slot.end - slot.start == wish.slot.end - wish.slot.start);
        for (const Slot& other : offered)
            RC_ASSERT(&slot == &other || !overlap(slot, other));
    }
    const TimeNs length = wish.slot.end - wish.slot.start;
    // Of 30 days on two rigs far more than four slots are free.
    RC_ASSERT(offered.size() == (length >= kBlock && length <= 24 * kBlock ? 4U : 0U));
}

TEST(Alternatives, OffersTheNearestFirstAndTheSameTimeElsewhere) {
    const Slot wanted{"rig-1", kNine + 6 * kBlock, kNine + 8 * kBlock};
    const std::vector<Booking> taken{booking(wanted.start, wanted.end)};
    const std::vector<std::string> both{"rig-1", "rig-2"};
    const auto offered = alternatives(wanted, both, taken, kNow);
    ASSERT_EQ(offered.size(), 3U);
    EXPECT_EQ(offered[0], (Slot{"rig-2", wanted.start, wanted.end}));
    EXPECT_EQ(offered[1], (Slot{"rig-1", kNine + 4 * kBlock, kNine + 6 * kBlock}));
    EXPECT_EQ(offered[2], (Slot{"rig-1", kNine + 8 * kBlock, kNine + 10 * kBlock}));
}

}  // namespace
}  // namespace kinectlab::lab
