#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kinectlab::experiments {

inline constexpr const char* kUnitsOfTables =
    "t takes s, ms, us, ns or min; x, y and z take m, cm, mm, in or px";

/// As --units writes it, whatever a head calls it ("µs" → "us", "pixels" → "px"); nothing for one
/// that is unknown or of something else.
[[nodiscard]] std::optional<std::string> known_unit(std::string_view written, bool is_time);

/// Seconds, metres or, of px, thousandths in one known unit.
[[nodiscard]] double scale_of_unit(std::string_view unit);

/// A column's head in its parts: "x (cm)", "x [cm]", "x/cm", "x, cm", and "x_cm" where cm is known.
struct TableHead {
    std::string whole;  ///< in small letters
    std::string name;   ///< in small letters
    std::string unit;   ///< as it stands there, maybe empty
};

[[nodiscard]] TableHead parse_head(std::string_view cell);

}  // namespace kinectlab::experiments
