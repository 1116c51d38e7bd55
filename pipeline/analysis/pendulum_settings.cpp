#include "pipeline/analysis/pendulum_settings.hpp"

namespace kinectlab {

std::vector<AnalysisSetting> pendulum_setting_list() {
    return {
        {"length_m",
         0.05,
         100.0,
         {},
         "From the pivot to the centre of the bob. Without it the arc itself tells, much less "
         "precisely; in pixels g is then left out."},
        {"length_u_m", 0.0, 10.0, 0.0005, "Standard uncertainty of the length."},
        {"bob_radius_m",
         0.0,
         10.0,
         {},
         "Of a solid ball that turns with the string; without it up to 0.06 of the length is in "
         "the budget."},
        {"bob_density_kg_m3",
         0.0,
         30000.0,
         {},
         "Without it the air is in the budget as for wood, 600 kg/m³. 0: too heavy for air and "
         "string to matter."},
        {"air_density_kg_m3", 0.0, 100.0, {}, "1.2 in a room, 0 in a vacuum."},
        {"string_mass_kg",
         0.0,
         100.0,
         {},
         "From the pivot to the bob; without it up to 5 g for each metre is in the budget."}};
}

PendulumSettings pendulum_settings(
    const AnalysisSettings& given, const AnalysisConditions& conditions
) {
    const auto optional = [&](const char* name) -> std::optional<double> {
        const auto found = given.find(name);
        return found == given.end() ? std::nullopt : std::optional(found->second);
    };
    PendulumSettings settings;
    settings.length_m = optional("length_m");
    settings.length_u_m = given.at("length_u_m");
    settings.body = {
        optional("bob_radius_m"),
        optional("bob_density_kg_m3"),
        optional("air_density_kg_m3"),
        optional("string_mass_kg")};
    settings.latitude_deg = optional("latitude_deg").value_or(0.0);
    settings.depth_scale_u = conditions.depth_scale_u;
    settings.clock_u = conditions.clock_u;
    settings.tilt_u_rad = conditions.tilt_u_rad;
    settings.on_earth = conditions.on_earth;
    settings.metric = conditions.metric;
    return settings;
}

}  // namespace kinectlab
