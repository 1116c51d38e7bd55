#include "server/experiments/units_of_names.hpp"

#include <array>

namespace kinectlab::experiments {
namespace {

struct Ending {
    std::string_view end;
    std::string_view unit;
};

// Longer ones before those that they end with.
constexpr std::array<Ending, 18> kEndings{{
    {"_kg_m3", "kg/m³"},
    {"_m_s2", "m/s²"},
    {"_deg_s", "°/s"},
    {"_m_s", "m/s"},
    {"_n_m", "N/m"},
    {"_per_rad", "1/rad"},
    {"_per_s", "1/s"},
    {"_per_m", "1/m"},
    {"_rad_s", "rad/s"},
    {"_deg", "°"},
    {"_rad", "rad"},
    {"_hz", "Hz"},
    {"_kg", "kg"},
    {"_mm", "mm"},
    {"_cm", "cm"},
    {"_min", "min"},
    {"_m", "m"},
    {"_s", "s"},
}};

}  // namespace

std::string_view unit_in_name(std::string_view name) {
    for (const auto& [end, unit] : kEndings)
        if (name.size() > end.size() && name.substr(name.size() - end.size()) == end) return unit;
    return {};
}

}  // namespace kinectlab::experiments
