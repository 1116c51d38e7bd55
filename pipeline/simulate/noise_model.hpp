#pragma once

#include <string_view>

#include "pipeline/core/error.hpp"

namespace kinectlab::simulate {

enum class NoiseModel {
    none,        ///< Exact depth, rounded to millimetres.
    khoshelham,  ///< d' ← round(d' + N(0, 0.5)), every pixel for itself: the noise of the bounds.
    kinect,      ///< As strong, but coupled between neighbours; ragged edges, shadow and holes too.
};

/// "none", "khoshelham" or "kinect"; anything else is an error of the field "noise".
[[nodiscard]] Result<NoiseModel> noise_model_named(std::string_view name);

}  // namespace kinectlab::simulate
