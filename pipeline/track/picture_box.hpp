#pragma once

#include <string>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/track/object_spec.hpp"

namespace kinectlab {

/// Refuses a box that is empty or not wholly inside the picture; `field` names it.
[[nodiscard]] Result<void> check_box(
    const PictureBox& box, const Pinhole& picture, const std::string& field
);

/// Refuses a time that is not 0 to 86,400 s.
[[nodiscard]] Result<void> check_learn_at(double learn_at_s, const std::string& field);

}  // namespace kinectlab
