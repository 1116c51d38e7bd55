#include "pipeline/analysis/swing_notes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/analysis/swing_measurements.hpp"

namespace kinectlab {
namespace {

const SwingParameters* under(const DragChoice& drag, DragLaw law) {
    const auto found = std::find_if(drag.models.begin(), drag.models.end(), [&](const auto& m) {
        return m.law == law;
    });
    return found == drag.models.end() ? nullptr : &found->parameters;
}

/// What it costs that the arc had to say how long the pendulum is.
std::string length_note(const SwingFit& fit, const Measurement& g) {
    const double radius = fit.parameters.radius;
    constexpr double kRule = 5e-4;  // m, what a ruler gives
    const double with_ruler = std::hypot(
        g.value * fit.omega0_sq_u_at_radius / fit.parameters.omega0_sq, g.value * kRule / radius
    );
    return fmt::format(
        "length_m was not given: the arc itself says {:.4f} m, known to {:.1f} mm. That is why g "
        "is "
        "known to {:.2g} m/s² only; with a length measured to 0.5 mm it would be {:.2g} m/s².",
        radius,
        fit.free_radius_u * 1e3,
        g.u,
        with_ruler
    );
}

}  // namespace

std::string drag_note(const SwingFit& fit) {
    const DragChoice& drag = fit.drag;
    const std::string figures = fmt::format(
        " (F = {:.1f} for the linear term, {:.1f} for the quadratic one)",
        drag.f_linear,
        drag.f_quadratic
    );
    if (drag.law == DragLaw::both && drag.linear_seen)
        return "Drag: linear and quadratic, both show in the amplitude's fall" + figures + ".";
    if (drag.law == DragLaw::both)
        return "Drag: quadratic; as the speed squared the air takes the swing away better than as "
               "the speed" +
               figures +
               ". A linear term does not show by itself, but both are given, because what "
               "quadratic_damping comes to depends on it.";
    if (drag.law == DragLaw::quadratic)
        return "Drag: quadratic; as the speed squared the air takes the swing away better than as "
               "the speed" +
               figures +
               ". What a linear term too weak to be seen may do to quadratic_damping is in its "
               "budget.";
    if (drag.told_apart || fit.parameters.damping <= 0.0)
        return "Drag: linear; a quadratic term is not seen" + figures +
               ". damping is the rate at which all drag together makes this amplitude fall.";
    const SwingParameters* other = under(drag, DragLaw::quadratic);
    return fmt::format(
        "Drag: counted as linear; this run does not tell linear from quadratic drag{}. damping is "
        "the rate at which all drag together makes this amplitude fall{}.",
        figures,
        other != nullptr
            ? fmt::format(", as quadratic drag it would be {:.3g}/rad", other->quadratic)
            : std::string()
    );
}

std::vector<std::string> swing_notes(
    const SwingFit& fit,
    const std::vector<Measurement>& measurements,
    const PendulumSettings& settings
) {
    std::vector<std::string> notes{drag_note(fit)};
    const bool has_g = !measurements.empty() && measurements.front().name == "g";
    if (!settings.length_m && has_g) notes.push_back(length_note(fit, measurements.front()));
    if (!settings.metric)
        notes.emplace_back(
            settings.length_m
                ? "Positions are in pixels: the arc's radius is only used for the amplitude's "
                  "angle, and g rests on the length that was given."
                : "Positions are in pixels and length_m was not given: g needs a length in metres "
                  "and is left out; everything that needs no scale is given."
        );
    else if (!has_g)
        notes.push_back(fmt::format(
            "length_m was not given, and the arc is too flat to show it ({:.2f} m, known to {:.2f} "
            "m): g is left out. Give the length, or swing wider.",
            fit.free_radius,
            fit.free_radius_u
        ));
    if (has_g) {
        const PendulumCorrections corrections(
            settings.body, settings.length_m.value_or(fit.parameters.radius)
        );
        notes.insert(notes.end(), corrections.notes().begin(), corrections.notes().end());
    }
    return notes;
}

}  // namespace kinectlab
