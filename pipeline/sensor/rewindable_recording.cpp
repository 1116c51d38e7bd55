#include "pipeline/sensor/rewindable_recording.hpp"

#include <utility>

#include "pipeline/core/file_ending.hpp"

namespace kinectlab {

RewindableRecording::RewindableRecording(
    std::filesystem::path path, const RecordingOptions& options, std::size_t most_kept
)
    : path_(std::move(path)),
      options_(options),
      room_(most_kept),
      keeps_all_(file_ending(path_) != ".oni") {}

Result<std::unique_ptr<RewindableRecording>> RewindableRecording::open(
    std::filesystem::path path, const RecordingOptions& options, std::size_t most_kept
) {
    auto source = open_recording(path, options);
    if (!source) return tl::unexpected(source.error());
    std::unique_ptr<RewindableRecording> recording(
        new RewindableRecording(std::move(path), options, most_kept)
    );
    recording->source_ = std::move(*source);
    recording->info_ = recording->source_->info();
    return recording;
}

Result<FrameStatus> RewindableRecording::next(RgbdFrame& frame, std::chrono::milliseconds timeout) {
    if (rewound_ && !kept_.empty()) {
        frame = std::move(kept_.front());
        kept_.pop_front();
        return FrameStatus::frame;
    }
    auto status = source_->next(frame, timeout);
    if (!rewound_ && keeps_all_ && status == FrameStatus::frame) keep(frame);
    return status;
}

void RewindableRecording::keep(const RgbdFrame& frame) {
    const std::size_t bytes = sizeof(std::uint16_t) * frame.depth.size() + frame.rgb.size();
    keeps_all_ = bytes <= room_;
    if (!keeps_all_) {
        kept_ = {};
        return;
    }
    room_ -= bytes;
    kept_.push_back(frame);
}

Result<void> RewindableRecording::rewind() {
    rewound_ = true;
    if (keeps_all_) return {};
    source_.reset();  // an .oni file has one player, which must start anew
    auto again = open_recording(path_, options_);
    if (!again) return tl::unexpected(again.error());
    source_ = std::move(*again);
    return {};
}

}  // namespace kinectlab
