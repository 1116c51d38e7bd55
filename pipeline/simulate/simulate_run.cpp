#include "pipeline/simulate/simulate_run.hpp"

#include <cmath>
#include <string>

#include "pipeline/core/number_text.hpp"

namespace kinectlab::simulate {
namespace {

constexpr double kLongestRun = 86400.0;

Result<void> check(const RunSettings& settings) {
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

    const auto hold_at = [&](double value) -> Result<void> {
        if (auto ok = rig->apply({Action::displace, value}); !ok) return ok;
        while (rig->apparatus().motion() != Motion::held)
            if (auto ok = show(); !ok) return ok;
        return show_for(settings.held_s);
    };

    const double value = settings.displacement.value_or(rig->apparatus().usual_value());
    if (auto ok = show_for(settings.rest_s); !ok) return tl::unexpected(ok.error());
    if (const auto aside = rig->apparatus().aside(value))
        if (auto ok = hold_at(*aside); !ok) return tl::unexpected(ok.error());
    if (auto ok = hold_at(value); !ok) return tl::unexpected(ok.error());
    if (auto ok = rig->apply({Action::release, 0.0}); !ok) return tl::unexpected(ok.error());
    summary.first_free = summary.frames;
    summary.release_s = rig->apparatus().t_s();
    if (auto ok = show_for(settings.seconds); !ok) return tl::unexpected(ok.error());
    return summary;
}

}  // namespace kinectlab::simulate
