#include "server/commands/readings.hpp"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "pipeline/preprocess/cleaner.hpp"

namespace kinectlab::commands {
namespace {

constexpr std::size_t kAllCounts = 65536;

}  // namespace

Readings::Readings(std::optional<MovingLeastSquaresSettings> smoothing)
    : smoothing_(smoothing), seen_(kAllCounts) {}

void Readings::add(const RgbdFrame& frame) {
    const auto is_reading = [](std::uint16_t counts) {
        return counts != 0;
    };
    any_ = any_ || std::any_of(frame.depth.begin(), frame.depth.end(), is_reading);
    if (!smoothing_) return;
    for (const std::uint16_t counts : frame.depth)
        ++seen_[counts];
}

void Readings::warn(const SourceInfo& source) const {
    if (!any_)
        std::cerr << "warning: " << source.name
                  << ": no frame has a reading, so nothing can be found; see whether the depth "
                     "pictures are the right ones\n";
    if (smoothing_) warn_of_smoothing(source.camera);
}

void Readings::warn_of_smoothing(const RgbdCamera& camera) const {
    const double nearest_m = nearest_smoothed_m(camera, *smoothing_);
    const std::size_t readings = nearer_than(kAllCounts);
    const std::size_t too_near = nearer_than(nearest_m / camera.depth_unit_m);
    const auto percent = 100.0 * static_cast<double>(too_near) /
                         static_cast<double>(std::max<std::size_t>(1, readings));
    if (percent < 1.0) return;
    std::size_t first = 1;  // counts that all but a hundredth of the readings reach
    while (first < seen_.size() && 100 * nearer_than(static_cast<double>(first)) < readings)
        ++first;
    const double most_m =
        smoothing_->radius_m * static_cast<double>(first - 1) * camera.depth_unit_m / nearest_m;
    std::fprintf(
        stderr,
        "warning: preprocess.smoothing.radius_m: is %.3g m, which is more than %d pixels of "
        "this camera nearer than %.2f m; %.0f %% of the readings are nearer and were left out; "
        "give at most %.2g m for this recording\n",
        smoothing_->radius_m,
        kMostPixels - 1,
        nearest_m,
        percent,
        most_m
    );
}

std::size_t Readings::nearer_than(double counts) const {
    std::size_t sum = 0;
    for (std::size_t i = 1; i < seen_.size() && static_cast<double>(i) < counts; ++i)
        sum += seen_[i];
    return sum;
}

}  // namespace kinectlab::commands
