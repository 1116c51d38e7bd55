#include "pipeline/sensor/read_ahead.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

using namespace std::chrono_literals;

enum class Ending { end, error, exception };

/// Gives frames whose index and only pixel count up, and then what it is told to.
class Counter : public FrameSource {
public:
    Counter(std::uint64_t frames, Ending ending, std::atomic<std::uint64_t>& given)
        : frames_(frames), ending_(ending), given_(given) {
        info_.name = "counter";
    }

    [[nodiscard]] const SourceInfo& info() const override { return info_; }

    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds) override {
        if (given_ == frames_) {
            if (ending_ == Ending::exception) throw std::runtime_error("no memory");
            if (ending_ == Ending::error)
                return fail(ErrorCode::bad_data, "7.png", "is damaged", "mend it");
            return FrameStatus::end;
        }
        frame.index = given_;
        frame.depth.assign(1, static_cast<std::uint16_t>(given_));
        ++given_;
        return FrameStatus::frame;
    }

private:
    SourceInfo info_;
    std::uint64_t frames_;
    Ending ending_;
    std::atomic<std::uint64_t>& given_;
};

struct Reading {
    explicit Reading(std::uint64_t frames, Ending ending = Ending::end)
        : source(read_ahead(std::make_unique<Counter>(frames, ending, given))) {}

    void expect_frames(std::uint64_t frames) {
        for (std::uint64_t i = 0; i < frames; ++i) {
            ASSERT_EQ(source->next(frame, 1s), FrameStatus::frame);
            EXPECT_EQ(frame.index, i);
            EXPECT_EQ(frame.depth, std::vector<std::uint16_t>{static_cast<std::uint16_t>(i)});
        }
    }

    std::atomic<std::uint64_t> given = 0;
    std::unique_ptr<FrameSource> source;
    RgbdFrame frame;
};

TEST(ReadAhead, GivesAllFramesInOrderAndThenTheEnd) {
    Reading reading(1000);
    EXPECT_EQ(reading.source->info().name, "counter");
    reading.expect_frames(1000);
    EXPECT_EQ(reading.source->next(reading.frame, 1s), FrameStatus::end);
    EXPECT_EQ(reading.source->next(reading.frame, 1s), FrameStatus::end);
}

TEST(ReadAhead, AnErrorComesAfterTheFramesBeforeIt) {
    Reading reading(7, Ending::error);
    reading.expect_frames(7);
    for (int twice = 0; twice < 2; ++twice) {
        const auto status = reading.source->next(reading.frame, 1s);
        ASSERT_FALSE(status);
        EXPECT_EQ(status.error().field, "7.png");
    }
}

TEST(ReadAhead, AnExceptionComesToWhoAsks) {
    Reading reading(3, Ending::exception);
    reading.expect_frames(3);
    EXPECT_THROW((void)reading.source->next(reading.frame, 1s), std::runtime_error);
}

TEST(ReadAhead, WaitsWhileNobodyAsks) {
    Reading reading(1000);
    reading.expect_frames(1);
    std::this_thread::sleep_for(50ms);
    EXPECT_LE(reading.given, 5U);  // the one that was taken and four ahead
}

TEST(ReadAhead, CanBeLeftAtAnyTime) {
    for (std::uint64_t frames = 0; frames < 8; ++frames) {
        Reading reading(100);
        reading.expect_frames(frames);
    }
}

}  // namespace
}  // namespace kinectlab
