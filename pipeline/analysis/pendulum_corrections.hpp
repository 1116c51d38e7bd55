#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/measurement.hpp"

namespace kinectlab {

/// What hangs there; each that is not given is not corrected for.
struct PendulumBody {
    std::optional<double> bob_radius_m;       ///< solid sphere that turns with the string
    std::optional<double> bob_density_kg_m3;  ///< 0: as if air and string weighed nothing beside it
    std::optional<double> air_density_kg_m3;  ///< 0: in a vacuum
    std::optional<double> string_mass_kg;     ///< of an even string from the pivot to the centre
};

/// From the frequency of small swings to g, for a rigid body of string and bob in air that is drawn
/// along with half the mass it gives way to (Nelson and Olsson, Am. J. Phys. 54 (1986) 112):
///   omega0² = g (m L + m_s L/2 - m_d L) / (m (L² + 2r²/5) + m_s L²/3 + m_d L²/2)
class PendulumCorrections {
public:
    /// `length_m` says how large what is not known can be: a bob's radius of at most 0.06 of it.
    PendulumCorrections(const PendulumBody& body, double length_m);

    /// g over omega0², m.
    [[nodiscard]] double reduced_length(double length_m) const;

    /// The relative standard uncertainties of g by what was not given: "bob size", "air", "string";
    /// each from zero to a bound, all values alike likely, and taken as zero.
    [[nodiscard]] const std::vector<BudgetLine>& unknown() const { return unknown_; }

    /// A sentence for each of them.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

private:
    void leave_out(const char* source, double bound, std::string note);

    double bob_radius_m_ = 0.0;
    double air_share_ = 0.0;     ///< of the displaced air in the bob's mass
    double string_share_ = 0.0;  ///< of the string's mass in the bob's
    std::vector<BudgetLine> unknown_;
    std::vector<std::string> notes_;
};

}  // namespace kinectlab
