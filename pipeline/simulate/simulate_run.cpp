#include "pipeline/simulate/simulate_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "pipeline/core/number_text.hpp"

namespace kinectlab::simulate {
namespace {

constexpr double kLargestAmplitude = std::numbers::pi / 3.0;
constexpr double kLongestRun = 86400.0;

Result<void> check(const RunSettings& settings) {
    const double amplitude = std::abs(settings.amplitude_rad);
    if (!(amplitude >= 1e-4 && amplitude <= kLargestAmplitude))
        return fail(
            ErrorCode::invalid_argument,
            "amplitude_deg",
            "is " + number_text(settings.amplitude_rad * 180.0 / std::numbers::pi),
            "give an angle from 0.01 to 60"
        );
    if (!(settings.seconds >= 0.1 && settings.seconds <= kLongestRun))
        return fail(
            ErrorCode::invalid_argument,
            "seconds",
            "is " + number_text(settings.seconds),
            "give a number from 0.1 to 86400"
        );
    if (!(settings.rest_s >= 0.0 && settings.held_s >= 0.0))
        return fail(ErrorCode::invalid_argument, "rest_s", "is negative", "give 0 or more");
    return {};
}

// Where the bob leaves free what it hides at rest: its centre two and a half radii to the side.
double angle_aside(const RunSettings& settings) {
    const auto& pendulum = settings.rig.pendulum;
    const double sine = 2.5 * pendulum.bob_radius_m / pendulum.length_m;
    return std::min(std::asin(std::min(sine, 1.0)), std::numbers::pi / 6.0);
}

}  // namespace

Result<RunSummary> simulate_run(const RunSettings& settings, const FrameSink& sink) {
    if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
    auto rig = SimulatedRig::create(settings.rig);
    if (!rig) return tl::unexpected(rig.error());

    RgbdFrame frame;
    RunSummary summary;
    const auto time_of = [](std::uint64_t k) {
        return static_cast<double>(k) / kFrameRateHz;
    };
    const auto show = [&]() -> Result<void> {
        rig->advance_to(time_of(summary.frames));
        rig->render(frame);
        ++summary.frames;
        return sink(frame, rig->truth());
    };
    const auto show_for = [&](double seconds) -> Result<void> {
        const auto frames = static_cast<std::uint64_t>(std::llround(seconds * kFrameRateHz));
        for (const std::uint64_t end = summary.frames + frames; summary.frames < end;)
            if (auto ok = show(); !ok) return ok;
        return {};
    };

    const auto hold_at = [&](double angle_rad) -> Result<void> {
        if (auto ok = rig->apply({Action::displace, angle_rad}); !ok) return ok;
        while (rig->truth().motion != Motion::held)
            if (auto ok = show(); !ok) return ok;
        return show_for(settings.held_s);
    };

    if (auto ok = show_for(settings.rest_s); !ok) return tl::unexpected(ok.error());
    if (const double aside = angle_aside(settings); aside > std::abs(settings.amplitude_rad))
        if (auto ok = hold_at(std::copysign(aside, settings.amplitude_rad)); !ok)
            return tl::unexpected(ok.error());
    if (auto ok = hold_at(settings.amplitude_rad); !ok) return tl::unexpected(ok.error());
    if (auto ok = rig->apply({Action::release, 0.0}); !ok) return tl::unexpected(ok.error());
    summary.first_swinging = summary.frames;
    summary.release_s = rig->truth().t_s;
    if (auto ok = show_for(settings.seconds); !ok) return tl::unexpected(ok.error());
    return summary;
}

}  // namespace kinectlab::simulate
