#include "server/lab/run.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "server/lab/permissions.hpp"

namespace kinectlab::lab {
namespace {

constexpr std::array kAllStates{
    RunState::preparing,
    RunState::ready,
    RunState::releasing,
    RunState::measuring,
    RunState::analysing,
    RunState::completed,
    RunState::aborted,
    RunState::failed,
    RunState::interrupted};

constexpr std::array kAllEvents{
    RunEvent::prepared,
    RunEvent::release_commanded,
    RunEvent::released,
    RunEvent::measured,
    RunEvent::analysed,
    RunEvent::abort,
    RunEvent::fail,
    RunEvent::interrupt};

TEST(RunMachine, LeadsFromPreparingToCompleted) {
    RunState state = RunState::preparing;
    for (const RunEvent event :
         {RunEvent::prepared,
          RunEvent::release_commanded,
          RunEvent::released,
          RunEvent::measured,
          RunEvent::analysed}) {
        const auto following = next(state, event);
        ASSERT_TRUE(following) << to_text(state) << " " << to_text(event);
        EXPECT_EQ(static_cast<int>(*following), static_cast<int>(state) + 1);
        state = *following;
    }
    EXPECT_EQ(state, RunState::completed);
}

TEST(RunMachine, EveryStateOnTheWayHasOneWayOnAndThreeWaysOut) {
    for (const RunState state : kAllStates) {
        int possible = 0;
        for (const RunEvent event : kAllEvents)
            possible += next(state, event) ? 1 : 0;
        EXPECT_EQ(possible, is_final(state) ? 0 : 4) << to_text(state);
    }
}

TEST(RunMachine, RefusalsAreConflictsThatNameTheState) {
    const auto refused = next(RunState::preparing, RunEvent::measured);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::conflict);
    EXPECT_NE(refused.error().message.find("preparing"), std::string::npos);
    EXPECT_FALSE(next(RunState::completed, RunEvent::abort));
}

TEST(RunMachine, NamesGoThereAndBack) {
    for (const RunState state : kAllStates)
        EXPECT_EQ(run_state_from_text(to_text(state)), state);
    EXPECT_FALSE(run_state_from_text("gone"));
    for (const char* role : {"student", "assistant", "instructor", "staff", "admin"}) {
        EXPECT_EQ(to_text(role_from_text(role).value()), role);
    }
    EXPECT_FALSE(role_from_text("root"));
}

RC_GTEST_PROP(RunMachineProperty, AFinalStateIsReachedAndNeverLeft, (std::vector<unsigned> picks)) {
    RunState state = RunState::preparing;
    bool was_final = false;
    for (const unsigned pick : picks) {
        const auto following = next(state, kAllEvents.at(pick % kAllEvents.size()));
        RC_ASSERT(!(was_final && following));
        RC_ASSERT(!following || *following > state);
        state = following.value_or(state);
        was_final = is_final(state);
    }
}

const User kOwner{.id = 1, .role = Role::student};
const User kOther{.id = 2, .role = Role::student};
const User kAssistant{.id = 3, .role = Role::assistant};
const User kStaff{.id = 4, .role = Role::staff};
constexpr TimeNs kMinute = 60 * kNsPerSecond;
const Booking kBooking{.user = 1, .slot = {"rig-1", 100 * kMinute, 110 * kMinute}};

TEST(Permissions, OnlyTheOwnerStartsARunAndOnlyInsideTheSlot) {
    EXPECT_TRUE(may_start_run(kOwner, kBooking, 60.0, 100 * kMinute));
    EXPECT_EQ(
        may_start_run(kOther, kBooking, 60.0, 100 * kMinute).error().code, ErrorCode::forbidden
    );
    EXPECT_FALSE(may_start_run(kStaff, kBooking, 60.0, 100 * kMinute));
    EXPECT_EQ(
        may_start_run(kOwner, kBooking, 60.0, 100 * kMinute - 1).error().code, ErrorCode::conflict
    );
    EXPECT_FALSE(may_start_run(kOwner, kBooking, 60.0, 110 * kMinute));
}

TEST(Permissions, AMeasurementMustFitIntoWhatIsLeftOfTheSlot) {
    EXPECT_TRUE(may_start_run(kOwner, kBooking, 60.0, 108 * kMinute));
    EXPECT_FALSE(may_start_run(kOwner, kBooking, 60.0, 109 * kMinute));
    const auto too_long = may_start_run(kOwner, kBooking, 600.0, 100 * kMinute);
    ASSERT_FALSE(too_long);
    EXPECT_EQ(too_long.error().field, "duration_s");
}

TEST(Permissions, RunsBelongToTheirOwnerAndToTeachers) {
    const lab::Run run{.user = 1};
    EXPECT_TRUE(may_command_run(kOwner, run));
    EXPECT_TRUE(may_command_run(kAssistant, run));
    EXPECT_FALSE(may_command_run(kOther, run));
    EXPECT_FALSE(may_see_run(kOther, run));
    EXPECT_TRUE(may_see_run(kStaff, run));
}

TEST(Permissions, BookingsAreCancelledByOwnerOrStaffBeforeTheirEnd) {
    EXPECT_TRUE(may_cancel_booking(kOwner, kBooking, 105 * kMinute));
    EXPECT_TRUE(may_cancel_booking(kStaff, kBooking, 105 * kMinute));
    EXPECT_FALSE(may_cancel_booking(kAssistant, kBooking, 105 * kMinute));
    EXPECT_FALSE(may_cancel_booking(kOwner, kBooking, 110 * kMinute));
    EXPECT_TRUE(may_see_name(kAssistant, kBooking));
    EXPECT_FALSE(may_see_name(kOther, kBooking));
}

}  // namespace
}  // namespace kinectlab::lab
