#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/sensor/frame_source.hpp"

namespace kinectlab {

/// One organised .pcd file, or a folder of them in the order of their names (numbers by value).
/// A PCD file has neither a camera nor a time: the camera is camera.json's beside the file or
/// 640x480, 525, 525, 319.5, 239.5; the frames are taken to be 1/30 s apart from time 0. A cloud
/// whose points do not lie on that camera's rays is refused. Depth counts are 0.2 mm, which reaches
/// to 13.1 m; NaN and points behind the camera or beyond that become 0. A frame all of whose points
/// lie behind the camera has y up and z backwards, as PCL's viewers write it, and is turned about
/// x. A cloud of NaN alone is a frame without readings; one whose points all lie out of reach, as
/// in millimetres, is refused, and so is an empty one (WIDTH 0) or one of another size. camera.json
/// needs no depth_scale here: coordinates are metres.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_pcd_sequence(
    const std::filesystem::path& path
);

}  // namespace kinectlab
