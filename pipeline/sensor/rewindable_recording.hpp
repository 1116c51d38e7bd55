#pragma once

#include <deque>
#include <filesystem>
#include <memory>

#include "pipeline/sensor/recording.hpp"

namespace kinectlab {

/// A recording that is looked at from its start and then gone through from there again, decoded
/// once: until it is rewound its frames are kept. If they are too many, or are those of an .oni
/// file, whose player would run on meanwhile, it is opened again instead.
class RewindableRecording : public FrameSource {
public:
    static constexpr std::size_t kMostKept = 400'000'000;  ///< bytes: 20 s of 640x480 at 30 Hz

    [[nodiscard]] static Result<std::unique_ptr<RewindableRecording>> open(
        std::filesystem::path path,
        const RecordingOptions& options = {},
        std::size_t most_kept = kMostKept
    );

    [[nodiscard]] const SourceInfo& info() const override { return info_; }
    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds timeout)
        override;

    /// The next frame is the first one again. Only once.
    [[nodiscard]] Result<void> rewind();

private:
    RewindableRecording(
        std::filesystem::path path, const RecordingOptions& options, std::size_t most_kept
    );
    void keep(const RgbdFrame& frame);

    std::filesystem::path path_;
    RecordingOptions options_;
    std::size_t room_;  // bytes that may still be kept
    bool keeps_all_;
    bool rewound_ = false;
    std::deque<RgbdFrame> kept_;
    std::unique_ptr<FrameSource> source_;
    SourceInfo info_;
};

}  // namespace kinectlab
