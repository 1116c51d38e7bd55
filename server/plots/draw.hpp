#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/analysis/plot.hpp"
#include "pipeline/core/measurement.hpp"

namespace kinectlab::plots {

enum class Format { svg, png };

/// "svg" or "png".
[[nodiscard]] std::optional<Format> format_named(std::string_view name);

/// Of a picture, in pixels; letters keep their size.
struct Sheet {
    double width = 720.0;
    double height = 400.0;
    double equal_height = 620.0;  ///< of a plot with equal axes
};

/// The plot as a picture of that size, PNG in twice as many pixels.
/// A plot without one finite point says so instead of showing empty axes. Lettering by Cairo and
/// the system's fonts.
[[nodiscard]] std::string draw(const Plot& plot, Format format, const Sheet& sheet = {});

/// The budgets of all measurements as bars: each line's share of its measurement's u².
[[nodiscard]] std::string draw_budget(const std::vector<Measurement>& measurements, Format format);

}  // namespace kinectlab::plots
