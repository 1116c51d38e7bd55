#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"
#include "pipeline/sensor/frame_source.hpp"
#include "pipeline/sensor/tum_lists.hpp"

namespace kinectlab {

/// Writes frames as a folder in the TUM RGB-D layout that open_recording reads back: depth as
/// 16-bit PNG in millimetres, colour as 8-bit RGB, camera.json, the lists, groundtruth.txt if poses
/// are given. Everything goes to NAME.partial beside the folder first and gets its name in
/// finish(): a recording that has its name is whole. Without finish() nothing is left behind. One
/// thread owns a writer; two more of its own encode. A full disk throws.
class SequenceWriter {
public:
    /// Refuses a folder that is not empty, a file, and a parent that does not exist.
    [[nodiscard]] static Result<SequenceWriter> create(
        const std::filesystem::path& folder, const SourceInfo& source
    );

    SequenceWriter(SequenceWriter&&) noexcept;
    SequenceWriter& operator=(SequenceWriter&&) noexcept;
    ~SequenceWriter();

    /// Copies the frame; waits while the encoders are behind. Refuses a frame of another size than
    /// the camera's and a time that is not after the last one.
    [[nodiscard]] Result<void> add(const RgbdFrame& frame);

    /// A line of groundtruth.txt: where the object of the experiment really is (lab frame).
    void add_truth(const TumPose& pose);

    /// A line of groundtruth_NAME.txt, for one of several objects; `name` is fit for a file.
    void add_truth_of(const std::string& name, const TumPose& pose);

    /// Any further file, e.g. with the settings of a simulation; `name` without folders.
    void add_file(const std::string& name, const std::string& content);

    /// Waits for the encoders, writes the lists, gives the folder its name.
    void finish();

private:
    struct State;
    explicit SequenceWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab
