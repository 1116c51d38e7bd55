#include "pipeline/analysis/swing_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/swing_measurements.hpp"

namespace kinectlab {
namespace {

constexpr double kFrame = 0.05;  // s
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFewPeriods = 10.0;
constexpr double kUnsafe = 60.0 * kDegree;

Measurement named(const std::vector<Measurement>& all, std::string_view name) {
    const auto it =
        std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.name == name; });
    return it == all.end() ? Measurement{} : *it;
}

/// More of the variance from the scatter of this one run than from all else.
bool statistics_dominate(const Measurement& m) {
    const auto it = std::find_if(m.budget.begin(), m.budget.end(), [](const auto& line) {
        return line.source == "statistics";
    });
    return it != m.budget.end() && it->u * it->u > 0.5 * m.u * m.u;
}

}  // namespace

std::vector<std::string> swing_warnings(
    std::span<const PositionSample> samples,
    const SwingFit& fit,
    const std::vector<Measurement>& measurements,
    const PendulumSettings& settings
) {
    std::vector<std::string> warnings;
    const PositionSample& first = samples[fit.begin];
    const PositionSample& last = samples[fit.end - 1];
    const double periods = (last.t - first.t) / named(measurements, "period").value;
    const double left_out_before = first.t - samples.front().t;
    const double left_out_after = samples.back().t - last.t;
    if (left_out_before > kFrame)
        warnings.push_back(fmt::format(
            "The first {:.1f} s were not a free swing and were left out.", left_out_before
        ));
    if (left_out_after > kFrame)
        warnings.push_back(fmt::format(
            "The last {:.1f} s were not a free swing and were left out.", left_out_after
        ));
    const Measurement g = named(measurements, "g");
    if (periods < kFewPeriods && (g.value == 0.0 || statistics_dominate(g)))
        warnings.push_back(fmt::format(
            "Only {:.1f} periods were recorded; ten or more give a much better g.", periods
        ));

    std::vector<double> off;
    for (const auto& r : fit.residuals)
        off.push_back(r.norm());
    const double noise = median(std::move(off));
    const double amplitude = named(measurements, "amplitude").value;
    const char* unit = settings.metric ? "mm" : "px";
    const double path = fit.parameters.radius * std::sin(amplitude);
    if (path < 20.0 * noise)
        warnings.push_back(fmt::format(
            "The swing of {:.1f} {} to each side is small against the positions' noise of {:.1f} "
            "{}; release it from a larger angle.",
            path * 1e3,
            unit,
            noise * 1e3,
            unit
        ));
    if (amplitude > kUnsafe)
        warnings.push_back(fmt::format(
            "The amplitude is {:.0f}°: strings go slack and supports give way near 90°, so this "
            "result is not safe.",
            amplitude / kDegree
        ));

    const auto frames = static_cast<double>(last.index - first.index + 1);
    const double missing = 1.0 - static_cast<double>(fit.end - fit.begin) / frames;
    if (missing > 0.2)
        warnings.push_back(fmt::format(
            "The bob was not seen in {:.0f} % of the frames of the swing.", missing * 100.0
        ));
    const auto outliers = std::count(fit.used.begin(), fit.used.end(), false);
    if (static_cast<double>(outliers) > 0.05 * static_cast<double>(fit.used.size()))
        warnings.push_back(fmt::format(
            "{} of {} positions lie far off the swing and were left out; was something else in the "
            "picture?",
            outliers,
            fit.used.size()
        ));
    if (fit.reduced_chi2 > 2.0)
        warnings.push_back(fmt::format(
            "The positions scatter {:.1f} times as much about the fit as the tracker expects "
            "(reduced chi² {:.1f}); "
            "the uncertainties take this in, but look at the residuals.",
            std::sqrt(fit.reduced_chi2),
            fit.reduced_chi2
        ));

    if (settings.length_m && settings.metric) {
        const double radius_off = std::abs(fit.free_radius - *settings.length_m);
        const double radius_u = std::hypot(
            fit.free_radius_u, swing_priors(settings, fit.parameters.radius).radius_sigma
        );
        if (radius_off > 4.0 * radius_u && radius_off > 0.03 * *settings.length_m)
            warnings.push_back(fmt::format(
                "The arc's radius is {:.2f} m but the length given is {:.2f} m; g rests on that "
                "length.",
                fit.free_radius,
                *settings.length_m
            ));
    }
    if (fit.parameters.tilt.norm() > 2.0 * kDegree)
        warnings.push_back(fmt::format(
            "The swing's plumb line is {:.1f}° off the lab's vertical; is the camera's place set "
            "right?",
            fit.parameters.tilt.norm() / kDegree
        ));
    if (settings.on_earth && g.value != 0.0 && !is_earthly(g.value, 4.0 * g.u))
        warnings.push_back(fmt::format(
            "g = {:.3f} m/s² is not found on the Earth's ground ({} to {} m/s²); is the length "
            "right?",
            g.value,
            kLeastOnEarth,
            kMostOnEarth
        ));
    const Measurement damping = named(measurements, "damping");
    if (damping.value < -4.0 * damping.u)
        warnings.emplace_back("The swing grew by itself; something pushes the pendulum.");
    const double earth = earth_turning(settings.latitude_deg);
    const bool turning_known = !settings.flat && !settings.turning_free;
    if (turning_known && std::abs(fit.free_turning - earth) > 5.0 * fit.free_turning_u)
        warnings.push_back(fmt::format(
            "The swing's plane turns by {:.0f} °/h, the Earth would turn it by {:.0f} °/h; the "
            "suspension may favour a direction.",
            -fit.free_turning / kDegree * 3600.0,
            -earth / kDegree * 3600.0
        ));
    return warnings;
}

}  // namespace kinectlab
