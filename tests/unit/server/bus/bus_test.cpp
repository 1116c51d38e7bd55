#include "server/bus/bus.hpp"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace kinectlab::bus {
namespace {

PoseMeasured pose(TimeNs t, const std::string& rig = "rig-1") {
    PoseMeasured event{.rig = rig, .object = "bob"};
    event.sample.t = t;
    return event;
}

PictureTaken picture(TimeNs t) {
    return {.rig = "rig-1", .t = t};
}

RunChanged run_changed(lab::RunId id, lab::RunState state) {
    return {lab::Run{.id = id, .rig = "rig-1", .state = state}};
}

RigChanged rig_changed(const std::string& rig, const std::string& sentence) {
    return {lab::RigStatus{.id = rig, .sentence = sentence}};
}

TimeNs time_of(const Delivery& delivery) {
    return std::get<PoseMeasured>(*delivery.event).sample.t;
}

TEST(Bus, DeliversInOrderToEverySubscriber) {
    Bus bus;
    const auto one = bus.subscribe({});
    const auto two = bus.subscribe({});
    bus.publish(pose(1));
    bus.publish(run_changed(7, lab::RunState::ready));
    for (const auto& reader : {one.get(), two.get()}) {
        EXPECT_EQ(time_of(reader->try_next().value()), 1);
        EXPECT_EQ(std::get<RunChanged>(*reader->try_next().value().event).run.id, 7);
        EXPECT_FALSE(reader->try_next());
    }
}

TEST(Bus, FiltersByRig) {
    Bus bus;
    const auto reader = bus.subscribe({.rig = "rig-2"});
    bus.publish(pose(1, "rig-1"));
    bus.publish(pose(2, "rig-2"));
    EXPECT_EQ(time_of(reader->try_next().value()), 2);
    EXPECT_FALSE(reader->try_next());
}

TEST(Bus, NewestPosesWinAndTheLossIsCounted) {
    Bus bus;
    const auto reader = bus.subscribe({.poses = 3});
    for (TimeNs t = 1; t <= 10; ++t)
        bus.publish(pose(t));
    const auto first = reader->try_next().value();
    EXPECT_EQ(time_of(first), 8);
    EXPECT_EQ(first.dropped, 7U);
    EXPECT_EQ(reader->try_next().value().dropped, 0U);
    EXPECT_EQ(time_of(reader->try_next().value()), 10);
    EXPECT_EQ(reader->dropped(), 7U);
}

TEST(Bus, DropsNeverExceedWhatWasLostBetweenTwoDeliveries) {
    Bus bus;
    const auto reader = bus.subscribe({.poses = 1});
    bus.publish(pose(1));
    bus.publish(pose(2));
    EXPECT_EQ(reader->try_next().value().dropped, 1U);
    bus.publish(pose(3));
    EXPECT_EQ(reader->try_next().value().dropped, 0U);
}

TEST(Bus, PicturesAndPosesDoNotDriveEachOtherOut) {
    Bus bus;
    const auto reader = bus.subscribe({.poses = 1, .pictures = 1});
    bus.publish(pose(1));
    bus.publish(picture(1));
    bus.publish(picture(2));
    EXPECT_EQ(time_of(reader->try_next().value()), 1);
    const auto newest = reader->try_next().value();
    EXPECT_EQ(std::get<PictureTaken>(*newest.event).t, 2);
    EXPECT_EQ(newest.dropped, 1U);
}

TEST(Bus, StateChangesOfRunsAreNeverLost) {
    Bus bus;
    const auto reader = bus.subscribe({.poses = 1, .pictures = 1});
    for (lab::RunId id = 1; id <= 1000; ++id) {
        bus.publish(run_changed(id, lab::RunState::ready));
        bus.publish(pose(id));
    }
    lab::RunId expected = 1;
    while (const auto delivery = reader->try_next()) {
        if (const auto* changed = std::get_if<RunChanged>(delivery->event.get())) {
            EXPECT_EQ(changed->run.id, expected++);
        }
    }
    EXPECT_EQ(expected, 1001);
}

TEST(Bus, OnlyTheNewestStatusOfEachRigWaits) {
    Bus bus;
    const auto reader = bus.subscribe({});
    bus.publish(rig_changed("rig-1", "old"));
    bus.publish(rig_changed("rig-2", "other"));
    bus.publish(rig_changed("rig-1", "new"));
    EXPECT_EQ(std::get<RigChanged>(*reader->try_next().value().event).rig.sentence, "other");
    EXPECT_EQ(std::get<RigChanged>(*reader->try_next().value().event).rig.sentence, "new");
    EXPECT_FALSE(reader->try_next());
}

TEST(Bus, WakesOnlyWhereTheQueueWasEmptyAndNeverAfterTheEnd) {
    Bus bus;
    int woken = 0;
    auto reader = bus.subscribe({.wake = [&] {
        ++woken;
    }});
    bus.publish(pose(1));
    bus.publish(pose(2));
    EXPECT_EQ(woken, 1);
    while (reader->try_next()) {
    }
    bus.publish(pose(3));
    EXPECT_EQ(woken, 2);
    reader.reset();
    bus.publish(pose(4));
    EXPECT_EQ(woken, 2);
}

TEST(Bus, SubscriptionsMayOutliveTheBus) {
    auto bus = std::make_unique<Bus>();
    const auto reader = bus->subscribe({});
    bus->publish(pose(1));
    bus.reset();
    EXPECT_EQ(time_of(reader->try_next().value()), 1);
}

TEST(Bus, AReaderInAnotherThreadSeesEveryEventInOrder) {
    constexpr int kEvents = 5000;
    Bus bus;
    const auto reader = bus.subscribe({});
    std::thread publisher([&] {
        for (int id = 1; id <= kEvents; ++id)
            bus.publish(run_changed(id, lab::RunState::ready));
    });
    lab::RunId last = 0;
    while (last < kEvents) {
        const auto delivery = reader->next(std::chrono::seconds(10));
        ASSERT_TRUE(delivery);
        EXPECT_EQ(std::get<RunChanged>(*delivery->event).run.id, ++last);
    }
    publisher.join();
}

}  // namespace
}  // namespace kinectlab::bus
