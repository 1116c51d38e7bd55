#include "pipeline/analysis/pendulum_corrections.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace kinectlab {
namespace {

// What an ordinary pendulum has at most.
constexpr double kLargestBob = 0.06;       // radius over length
constexpr double kLightestBob = 600.0;     // kg/m³: wood
constexpr double kDensestAir = 1.2;        // kg/m³
constexpr double kHeaviestString = 0.005;  // kg/m: a cord of 2 to 3 mm
constexpr double kHeaviestShare = 0.02;    // of the bob's mass, where that is not known

}  // namespace

PendulumCorrections::PendulumCorrections(const PendulumBody& body, double length_m) {
    bob_radius_m_ = body.bob_radius_m.value_or(0.0);
    if (!body.bob_radius_m)
        leave_out(
            "bob size",
            0.4 * kLargestBob * kLargestBob,
            fmt::format(
                "bob_radius_m was not given: the bob counts as a point, and one of up to {:.0f} mm "
                "is in the budget.",
                kLargestBob * length_m * 1e3
            )
        );
    const bool heavy = body.bob_density_kg_m3 == 0.0;
    const bool vacuum = body.air_density_kg_m3 == 0.0;
    const double lightest = body.bob_density_kg_m3.value_or(kLightestBob);
    if (!heavy && !vacuum && body.bob_density_kg_m3 && body.air_density_kg_m3)
        air_share_ = *body.air_density_kg_m3 / *body.bob_density_kg_m3;
    else if (!heavy && !vacuum)
        leave_out(
            "air",
            1.5 * body.air_density_kg_m3.value_or(kDensestAir) / lightest,
            fmt::format(
                "{} was not given: the air's buoyancy and the air drawn along are not corrected "
                "for, and what a bob of {:.0f} kg/m³ would feel is in the budget.",
                body.bob_density_kg_m3 ? "air_density_kg_m3" : "bob_density_kg_m3",
                lightest
            )
        );
    if (heavy)
        notes_.emplace_back(
            "bob_density_kg_m3 is 0: the bob counts as so heavy that air and string do not matter."
        );
    if (heavy || body.string_mass_kg == 0.0) return;
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(bob_radius_m_, 3);
    const double mass = volume * lightest;
    if (body.string_mass_kg && body.bob_density_kg_m3 && mass > 0.0) {
        string_share_ = *body.string_mass_kg / mass;
        return;
    }
    const double heaviest = body.string_mass_kg.value_or(kHeaviestString * length_m);
    const double share = mass > 0.0 ? heaviest / mass : kHeaviestShare;
    leave_out(
        "string",
        share / 6.0,
        fmt::format(
            "{}: the string's mass is not corrected for, and one of up to {:.2g} % of the bob's "
            "is in the budget.",
            body.string_mass_kg
                ? "The bob's mass is not known without bob_radius_m and bob_density_kg_m3"
                : "string_mass_kg was not given",
            share * 100.0
        )
    );
}

void PendulumCorrections::leave_out(const char* source, double bound, std::string note) {
    unknown_.push_back({source, bound / std::sqrt(3.0)});
    notes_.push_back(std::move(note));
}

double PendulumCorrections::reduced_length(double l) const {
    const double inertia = l * l * (1.0 + string_share_ / 3.0 + air_share_ / 2.0) +
                           0.4 * bob_radius_m_ * bob_radius_m_;
    return inertia / (l * (1.0 + string_share_ / 2.0 - air_share_));
}

}  // namespace kinectlab
