#pragma once

#include <string>
#include <string_view>

namespace kinectlab::experiments {

/// The unit that a parameter's name promises by its end: "length_m" → "m", "rate_deg_s" → "°/s";
/// empty where it promises none ("gravity"). A "_u" before the unit ("length_u_m") changes nothing.
[[nodiscard]] std::string_view unit_in_name(std::string_view name);

}  // namespace kinectlab::experiments
