#pragma once

#include "pipeline/analysis/path_numbers.hpp"

namespace kinectlab {

/// The greatest of a smoothed path's speeds, without what noise alone adds to the greatest of many:
/// noise with the memories and sizes that the path shows is drawn, smoothed and added to a calmer
/// course of the speed, and the mean excess is taken off (parametric bootstrap, Efron & Tibshirani
/// 1993, chapter 10). The draws are the same for the same path. NaN where nothing moves.
[[nodiscard]] PathNumber greatest_speed(
    const SmoothPath& path, const PathNumbers& numbers, double half_window_s
);

}  // namespace kinectlab
