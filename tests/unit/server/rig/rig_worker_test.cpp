#include "server/rig/rig_worker.hpp"

#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/server/rig/played_rig.hpp"
#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::rig {
namespace {

using lab::RunEvent;
using lab::RunState;
using test::kMinute;
using test::kNoon;
using test::PlayedRig;
using test::TemporaryStore;

const TrackingPlan kBob{{{"bob", SphereSettings{.radius_m = 0.05}}}, {}};

class RigWorkerTest : public testing::Test {
protected:
    explicit RigWorkerTest(bool rendered = false)
        : ada_(store_.add_user("ada")),
          booking_(store_.add_booking(ada_, kNoon, kNoon + 60 * kMinute)),
          events_(bus_.subscribe({.poses = 100'000})),
          rig_(kNoon, rendered),
          worker_(
              {.id = "rig-1", .name = "Rig 1", .uri = "played://rig"},
              kBob,
              {[this] { return rig_.open(); }, [this] { return rig_.now(); }, {}},
              *store_,
              bus_
          ) {}

    /// Lets the rig's time go on. While an analysis runs, real time has to pass too.
    template <class Until>
    testing::AssertionResult step_until(const Until& until, double seconds = 120.0) {
        const double end = rig_.t_s + seconds;
        while (!until()) {
            if (rig_.t_s > end) return testing::AssertionFailure() << "not in time";
            const auto pause = worker_.step();
            // Frames move the rig's time on; where none comes, the worker's own pauses do.
            rig_.advance(std::chrono::duration<double>(pause).count());
            if (run_ && run().state == RunState::analysing) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        }
        return testing::AssertionSuccess();
    }
    void play(double seconds) {
        const double end = rig_.t_s + seconds;
        (void)step_until([&] { return rig_.t_s >= end; }, seconds + 1.0);
    }
    testing::AssertionResult step_until_state(RunState state, double seconds = 120.0) {
        return step_until([&] { return run().state == state; }, seconds);
    }

    void start(double duration_s = 10.0, TimeNs ready_for = 5 * kMinute) {
        play(1.5);
        lab::Run run = TemporaryStore::run_for(booking_, rig_.now());
        run.parameters = {
            {"length_m", 1.0},
            {"bob_radius_m", 0.05},
            {"amplitude_deg", 10.0},
            {"bob_density_kg_m3", 0.0}};
        run.duration_s = duration_s;
        run.release_until = rig_.now() + ready_for;
        const auto started = worker_.start(run, kBob);
        ASSERT_TRUE(started) << to_text(started.error());
        run_ = started->id;
    }
    Result<lab::Run> command(RunEvent event) {
        return worker_.advance(*run_, {event, rig_.now(), "said Ada", ada_.id});
    }
    void start_measuring(double duration_s = 10.0) {
        start(duration_s);
        ASSERT_TRUE(step_until_state(RunState::ready));
        ASSERT_TRUE(command(RunEvent::release_commanded));
        ASSERT_TRUE(step_until_state(RunState::measuring));
    }
    lab::Run run() { return store_->runs.find(*run_).value(); }
    [[nodiscard]] bool idle() const { return worker_.status().state == lab::RigState::idle; }
    /// Whatever the end of a run: the bob was stopped and the rig takes the next run.
    void expect_left_in_order() {
        EXPECT_TRUE(step_until([&] { return idle(); }));
        EXPECT_TRUE(step_until([&] { return rig_.truth().motion == simulate::Motion::at_rest; }));
        EXPECT_FALSE(worker_.status().current_run);
        start();
        EXPECT_TRUE(step_until_state(RunState::ready));
    }

    TemporaryStore store_;
    lab::User ada_;
    lab::Booking booking_;
    bus::Bus bus_;
    std::unique_ptr<bus::Subscription> events_;
    PlayedRig rig_;
    RigWorker worker_;
    std::optional<lab::RunId> run_;
};

class RenderedRigWorkerTest : public RigWorkerTest {
protected:
    RenderedRigWorkerTest() : RigWorkerTest(true) {}
};

TEST_F(RenderedRigWorkerTest, MeasuresGravityFromPreparationToResult) {
    start_measuring(10.0);
    ASSERT_TRUE(step_until([&] { return lab::is_final(run().state); }));
    const lab::Run done = run();
    ASSERT_EQ(done.state, RunState::completed) << done.reason;
    EXPECT_NEAR(static_cast<double>(done.frames), 300.0, 2.0);
    EXPECT_EQ(done.frames_lost, 0);

    const auto result = nlohmann::json::parse(done.result_json);
    EXPECT_EQ(result["experiment"], "pendulum");
    const auto& g = result["results"][0];
    EXPECT_EQ(g["name"], "g");
    EXPECT_EQ(g["unit"], "m/s²");
    EXPECT_LT(g["u"], 0.02);
    EXPECT_NEAR(g["value"], 9.81, 4.0 * g["u"].get<double>());
    EXPECT_FALSE(g["budget"].empty());
    const auto& provenance = result["provenance"];
    for (const char* key : {"version", "source", "configuration", "camera", "rig"}) {
        EXPECT_TRUE(provenance.contains(key)) << key;
    }
    const auto fit = nlohmann::json::parse(store_->results.latest(done.id)->fit_json);
    const auto& bob = fit["objects"][0];
    EXPECT_EQ(bob["object"], "bob");
    EXPECT_EQ(bob["t_s"].size(), bob["residual"]["x"].size());

    const auto poses = store_->poses.of_run(done.id);
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_EQ(static_cast<std::int64_t>(poses[0].samples.size()), done.frames);
    const auto tracked =
        std::count_if(poses[0].samples.begin(), poses[0].samples.end(), [](const MotionSample& s) {
            return s.status == TrackStatus::tracked;
        });
    EXPECT_GT(tracked, 290);

    int shown = 0;
    while (const auto delivery = events_->try_next()) {
        const auto* pose = std::get_if<bus::PoseMeasured>(delivery->event.get());
        if (pose != nullptr && pose->run == done.id) ++shown;
    }
    EXPECT_EQ(shown, done.frames);
}

TEST_F(RigWorkerTest, EveryStateIsStoredAndToldInOrder) {
    start_measuring();
    ASSERT_TRUE(command(RunEvent::measured));
    ASSERT_TRUE(step_until([&] { return lab::is_final(run().state); }));
    // Of a bare wall there is nothing to analyse: never a number.
    EXPECT_EQ(run().state, RunState::failed);
    EXPECT_TRUE(run().result_json.empty());

    const std::vector<RunState> expected{
        RunState::preparing,
        RunState::ready,
        RunState::releasing,
        RunState::measuring,
        RunState::analysing,
        RunState::failed};
    std::vector<RunState> stored;
    for (const auto& change : store_->runs.history(*run_))
        stored.push_back(change.state);
    EXPECT_EQ(stored, expected);
    std::vector<RunState> told;
    while (const auto delivery = events_->try_next()) {
        const auto* changed = std::get_if<bus::RunChanged>(delivery->event.get());
        if (changed == nullptr) continue;
        if (told.empty() || told.back() != changed->run.state) told.push_back(changed->run.state);
    }
    EXPECT_EQ(told, expected);
}

TEST_F(RigWorkerTest, TheBobIsHeldAtItsAngleWhenTheRunIsReady) {
    start();
    ASSERT_TRUE(step_until_state(RunState::ready));
    EXPECT_EQ(rig_.truth().motion, simulate::Motion::held);
    EXPECT_NEAR(rig_.truth().value, 10.0 * M_PI / 180.0, 0.005);
    EXPECT_EQ(worker_.status().state, lab::RigState::busy);
    EXPECT_EQ(worker_.status().current_run, run_);
}

TEST_F(RigWorkerTest, TheReleaseIsWhenTheActuatorSaysItWas) {
    start();
    ASSERT_TRUE(step_until_state(RunState::ready));
    const TimeNs let_go = rig_.now() + 5'000'000;
    rig_.since = let_go;
    play(0.1);
    ASSERT_TRUE(command(RunEvent::release_commanded));
    ASSERT_TRUE(step_until_state(RunState::measuring));
    EXPECT_EQ(run().started, let_go);
}

TEST_F(RigWorkerTest, AReleaseThatCannotBeIsNotBelieved) {
    start();
    ASSERT_TRUE(step_until_state(RunState::ready));
    rig_.since = rig_.now() - kMinute;
    const TimeNs commanded = rig_.now();
    ASSERT_TRUE(command(RunEvent::release_commanded));
    ASSERT_TRUE(step_until_state(RunState::measuring));
    EXPECT_GE(run().started.value(), commanded);
}

TEST_F(RigWorkerTest, MeasuresForItsDuration) {
    start_measuring(2.0);
    ASSERT_TRUE(step_until([&] { return run().state != RunState::measuring; }));
    EXPECT_NEAR(static_cast<double>(run().frames), 60.0, 2.0);
    ASSERT_TRUE(step_until([&] { return lab::is_final(run().state); }));
    expect_left_in_order();
}

TEST_F(RigWorkerTest, AbortWorksInEveryState) {
    start();
    ASSERT_TRUE(command(RunEvent::abort));
    expect_left_in_order();  // leaves the next run ready
    ASSERT_TRUE(command(RunEvent::abort));
    EXPECT_EQ(run().state, RunState::aborted);
    EXPECT_EQ(run().reason, "said Ada");
    expect_left_in_order();
    ASSERT_TRUE(command(RunEvent::release_commanded));
    ASSERT_TRUE(command(RunEvent::abort));
    expect_left_in_order();
    ASSERT_TRUE(command(RunEvent::release_commanded));
    ASSERT_TRUE(step_until_state(RunState::measuring));
    play(1.0);
    ASSERT_TRUE(command(RunEvent::abort));
    play(0.1);
    EXPECT_GT(run().frames, 25);
    EXPECT_GT(store_->poses.count(*run_), 25U);
    expect_left_in_order();
}

TEST_F(RigWorkerTest, CommandsInTheWrongStateAreConflicts) {
    start();
    EXPECT_EQ(command(RunEvent::release_commanded).error().code, ErrorCode::conflict);
    EXPECT_EQ(command(RunEvent::measured).error().code, ErrorCode::conflict);
    EXPECT_FALSE(worker_.advance(*run_ + 1, {RunEvent::abort, kNoon, "", {}}));
    EXPECT_EQ(
        worker_.start(TemporaryStore::run_for(booking_), kBob).error().code, ErrorCode::conflict
    );
}

TEST_F(RigWorkerTest, ARunThatNobodyReleasesIsGivenUp) {
    start(10.0, 30 * kNsPerSecond);
    ASSERT_TRUE(step_until_state(RunState::aborted));
    EXPECT_LT(rig_.now() - run().created, 31 * kNsPerSecond);
    expect_left_in_order();
}

TEST_F(RigWorkerTest, AnActuatorThatRefusesFailsTheRun) {
    start();
    rig_.refusing = true;
    ASSERT_TRUE(step_until_state(RunState::failed));
    EXPECT_NE(run().reason.find("actuator"), std::string::npos);
    ASSERT_TRUE(step_until([&] { return idle(); }));
    EXPECT_NE(worker_.status().sentence.find("not stopped"), std::string::npos);
}

TEST_F(RigWorkerTest, AnActuatorThatDoesNotObeyFailsThePreparation) {
    start();
    rig_.deaf = true;
    ASSERT_TRUE(step_until_state(RunState::failed));
    EXPECT_NE(run().reason.find("did not within"), std::string::npos);
}

TEST_F(RigWorkerTest, ABobThatIsNotLetGoFailsTheRun) {
    start();
    ASSERT_TRUE(step_until_state(RunState::ready));
    rig_.deaf = true;
    ASSERT_TRUE(command(RunEvent::release_commanded));
    ASSERT_TRUE(step_until_state(RunState::failed, 20.0));
    EXPECT_NE(run().reason.find("release"), std::string::npos);
}

TEST_F(RigWorkerTest, AShortSilenceOfTheCameraIsAGapAndALongOneAFailure) {
    start_measuring(60.0);
    play(1.0);
    rig_.status = FrameStatus::disconnected;
    play(2.0);
    EXPECT_EQ(run().state, RunState::measuring);
    rig_.status = FrameStatus::frame;
    rig_.skip = 60;
    play(1.0);
    EXPECT_EQ(run().state, RunState::measuring);
    rig_.status = FrameStatus::disconnected;
    ASSERT_TRUE(step_until_state(RunState::failed, 7.0));
    EXPECT_NE(run().reason.find("camera"), std::string::npos);
    EXPECT_EQ(run().frames_lost, 60);
    play(3.0);
    EXPECT_EQ(worker_.status().state, lab::RigState::offline);
    rig_.status = FrameStatus::frame;
    expect_left_in_order();
}

TEST_F(RigWorkerTest, LostFramesAreCountedForTheRunAndForTheRig) {
    play(1.0);
    rig_.skip = 2;
    play(0.5);
    start_measuring(2.0);
    play(0.5);
    rig_.skip = 3;
    ASSERT_TRUE(step_until([&] { return lab::is_final(run().state); }));
    EXPECT_EQ(run().frames_lost, 3);
    play(1.5);
    EXPECT_EQ(worker_.status().frames_lost, 5);
    EXPECT_NEAR(worker_.status().frame_rate_hz, 30.0, 0.5);
}

TEST_F(RigWorkerTest, ADeviceThatIsNotThereIsTriedAgain) {
    rig_.absent = true;
    play(1.0);
    EXPECT_EQ(worker_.status().state, lab::RigState::offline);
    EXPECT_NE(worker_.status().sentence.find("no such device"), std::string::npos);
    EXPECT_FALSE(worker_.picture());
    EXPECT_EQ(
        worker_.start(TemporaryStore::run_for(booking_), kBob).error().code, ErrorCode::unavailable
    );
    EXPECT_TRUE(store_->runs.list({}).empty());
    rig_.absent = false;
    EXPECT_TRUE(step_until([&] { return idle(); }, 5.0));
    EXPECT_TRUE(worker_.picture());
}

TEST_F(RigWorkerTest, ClosingInterruptsTheRunAndKeepsItsPoses) {
    start_measuring(60.0);
    play(2.0);
    const int stops = rig_.stops;
    worker_.close(RunEvent::interrupt, "the server was shut down");
    EXPECT_EQ(run().state, RunState::interrupted);
    EXPECT_EQ(run().reason, "the server was shut down");
    EXPECT_GT(rig_.stops, stops);
    EXPECT_EQ(static_cast<std::int64_t>(store_->poses.count(*run_)), run().frames);
    EXPECT_GT(run().frames, 55);
}

TEST_F(RigWorkerTest, AnAnalysisThatIsUnderWayIsNotThrownAwayByClosing) {
    start_measuring(2.0);
    ASSERT_TRUE(step_until([&] { return run().state != RunState::measuring; }));
    worker_.close(RunEvent::interrupt, "the server was shut down");
    EXPECT_EQ(run().state, RunState::failed);  // by the analysis: there was only a wall
}

TEST_F(RigWorkerTest, PicturesComeAtMostTenTimesASecond) {
    play(5.0);
    int pictures = 0;
    while (const auto delivery = events_->try_next()) {
        if (std::holds_alternative<bus::PictureTaken>(*delivery->event)) pictures += 1;
        pictures += static_cast<int>(delivery->dropped);
    }
    EXPECT_LE(pictures, 51);
    EXPECT_GE(pictures, 35);
}

}  // namespace
}  // namespace kinectlab::rig
