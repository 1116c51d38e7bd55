#pragma once

#include <memory>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

/// A recording's frames as `source` gives them, but taken from it by a thread of its own while the
/// last ones are worked on: at most four wait, then the thread does. Errors and the end come in
/// their place and are then repeated. It waits for as long as reading takes, whatever the timeout.
[[nodiscard]] std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source);

}  // namespace kinectlab
