#include "pipeline/sensor/rewindable_recording.hpp"

#include <gtest/gtest.h>

#include "pipeline/sensor/sequence_writer.hpp"
#include "tests/unit/pipeline/sensor/scratch_folder.hpp"

namespace kinectlab {
namespace {

using namespace std::chrono_literals;

constexpr int kSide = 16;
constexpr std::size_t kFrameBytes = 2 * kSide * kSide;
constexpr std::uint16_t kFrames = 6;

/// A recording whose depth counts the frames.
void write_recording(const std::filesystem::path& folder) {
    SourceInfo info;
    info.camera.depth = {kSide, kSide, 20.0, 20.0, 7.5, 7.5};
    auto writer = SequenceWriter::create(folder, info);
    ASSERT_TRUE(writer);
    for (std::uint16_t k = 0; k < kFrames; ++k) {
        RgbdFrame frame;
        frame.t = (k + 1) * kNsPerSecond;
        frame.depth.assign(kSide * kSide, static_cast<std::uint16_t>(1000 + k));
        ASSERT_TRUE(writer->add(frame));
    }
    writer->finish();
}

void expect_frames(FrameSource& source, std::uint16_t first, std::uint16_t last) {
    RgbdFrame frame;
    for (std::uint16_t k = first; k < last; ++k) {
        ASSERT_EQ(source.next(frame, 1s), FrameStatus::frame) << k;
        EXPECT_EQ(frame.index, k);
        EXPECT_EQ(frame.t, (k + 1) * kNsPerSecond);
        EXPECT_EQ(frame.depth.size(), std::size_t{kSide} * kSide);
        EXPECT_EQ(frame.depth.front(), 1000 + k);
    }
}

void expect_end(FrameSource& source) {
    RgbdFrame frame;
    EXPECT_EQ(source.next(frame, 1s), FrameStatus::end);
}

class RewindableRecordingTest : public testing::Test {
protected:
    void SetUp() override { write_recording(scratch / "r"); }

    std::unique_ptr<RewindableRecording> open(std::size_t frames_kept) {
        auto recording =
            RewindableRecording::open(scratch / "r", {.ahead = true}, frames_kept * kFrameBytes);
        return recording ? std::move(*recording) : nullptr;
    }

    test::ScratchFolder scratch;
};

TEST_F(RewindableRecordingTest, GivesTheSameFramesAgainAndTheRest) {
    for (const std::uint16_t looked_at : {0, 1, 3, 6})
        for (const std::size_t kept : {0, 2, 3, 100}) {
            const auto recording = open(kept);
            ASSERT_TRUE(recording);
            expect_frames(*recording, 0, looked_at);
            ASSERT_TRUE(recording->rewind());
            expect_frames(*recording, 0, kFrames);
            expect_end(*recording);
        }
}

TEST_F(RewindableRecordingTest, TheEndIsNoneOnceRewound) {
    const auto recording = open(100);
    ASSERT_TRUE(recording);
    expect_frames(*recording, 0, kFrames);
    expect_end(*recording);
    ASSERT_TRUE(recording->rewind());
    expect_frames(*recording, 0, kFrames);
    expect_end(*recording);
}

TEST_F(RewindableRecordingTest, KeptFramesAreNotReadAgain) {
    for (const std::size_t kept : {2, 3}) {
        const auto recording = open(kept);
        ASSERT_TRUE(recording);
        expect_frames(*recording, 0, 3);
        const auto away = scratch / "away";
        std::filesystem::rename(scratch / "r", away);
        EXPECT_EQ(recording->rewind().has_value(), kept == 3);
        std::filesystem::rename(away, scratch / "r");
    }
}

TEST_F(RewindableRecordingTest, WhatIsNoRecordingIsRefused) {
    EXPECT_FALSE(RewindableRecording::open(scratch / "nothing"));
}

}  // namespace
}  // namespace kinectlab
