#include "server/rig/rig_service.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::rig {
namespace {

using lab::RunState;
using test::kMinute;

TimeNs utc_now() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch()
    )
        .count();
}

/// The service with the simulated rig's own driver, in real time.
class RigServiceTest : public testing::Test {
protected:
    RigServiceTest() : ada_(store_.add_user("ada")), bob_(store_.add_user("bob")) {
        const TimeNs now = utc_now();
        const TimeNs start = now / (5 * kMinute) * (5 * kMinute);
        const auto booked = store_->bookings.add(
            {ada_.id, ada_.role, "pendulum", {"rig-1", start, start + 30 * kMinute}}, now
        );
        EXPECT_TRUE(booked);
        service_ = make_service();
    }

    std::unique_ptr<RigService> make_service() {
        return std::make_unique<RigService>(
            std::vector<RigSettings>{{"rig-1", "Rig 1", "sim://rig-1?seed=1"}},
            library_,
            *store_,
            bus_
        );
    }

    testing::AssertionResult wait_until(const std::function<bool()>& until, int seconds = 60) {
        for (int i = 0; i < seconds * 50; ++i) {
            if (until()) return testing::AssertionSuccess();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return testing::AssertionFailure() << "not in time";
    }
    bool free() { return service_->find("rig-1", utc_now())->state == lab::RigState::idle; }
    RunState state(lab::RunId run) { return store_->runs.find(run)->state; }
    Result<lab::Run> start(const lab::User& user, lab::Parameters parameters) {
        return service_->start_run(user, {"rig-1", "pendulum", std::move(parameters)}, utc_now());
    }

    test::TemporaryStore store_;
    ExperimentLibrary library_{
        experiments::load_definitions(std::string(KINECTLAB_SOURCE_DIR) + "/server/experiments")
            .value(),
        store_->definitions};
    lab::User ada_;
    lab::User bob_;
    bus::Bus bus_;
    std::unique_ptr<RigService> service_;
};

TEST_F(RigServiceTest, CarriesOutARunOnTheSimulatedRigAndKeepsItAcrossARestart) {
    ASSERT_TRUE(wait_until([&] { return free(); }));
    EXPECT_TRUE(service_->list(utc_now()).at(0).simulated);

    EXPECT_EQ(start(bob_, {}).error().code, ErrorCode::forbidden);
    EXPECT_EQ(start(ada_, {{"length_m", 99.0}}).error().field, "parameters.length_m");
    EXPECT_EQ(
        service_->start_run(ada_, {"rig-9", "pendulum", {}}, utc_now()).error().code,
        ErrorCode::not_found
    );

    const auto run = start(ada_, {{"duration_s", 10.0}});
    ASSERT_TRUE(run) << to_text(run.error());
    EXPECT_EQ(start(ada_, {}).error().code, ErrorCode::conflict);
    ASSERT_TRUE(wait_until([&] { return state(run->id) != RunState::preparing; }));
    ASSERT_EQ(state(run->id), RunState::ready) << store_->runs.find(run->id)->reason;
    EXPECT_EQ(service_->release(bob_, run->id, utc_now()).error().code, ErrorCode::forbidden);
    ASSERT_TRUE(service_->release(ada_, run->id, utc_now()));
    EXPECT_TRUE(service_->picture("rig-1"));
    ASSERT_TRUE(wait_until([&] { return lab::is_final(state(run->id)); }));

    const auto done = store_->runs.find(run->id).value();
    ASSERT_EQ(done.state, RunState::completed) << done.reason;
    const auto g = nlohmann::json::parse(done.result_json)["results"][0];
    EXPECT_NEAR(g["value"], 9.81, 4.0 * g["u"].get<double>());

    ASSERT_TRUE(wait_until([&] { return free(); }));
    const auto second = start(ada_, {});
    ASSERT_TRUE(second) << to_text(second.error());
    service_->shutdown();
    EXPECT_EQ(state(second->id), RunState::interrupted) << store_->runs.find(second->id)->reason;
    EXPECT_EQ(state(run->id), RunState::completed);
}

TEST_F(RigServiceTest, WhatACrashLeftOpenIsInterruptedAtTheStart) {
    service_->shutdown();
    auto open = test::TemporaryStore::run_for(store_->bookings.find(1).value(), utc_now());
    const auto run = store_->runs.add(open);
    ASSERT_TRUE(run);
    service_ = make_service();
    EXPECT_EQ(state(run->id), RunState::interrupted);
}

}  // namespace
}  // namespace kinectlab::rig
