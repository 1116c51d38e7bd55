#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/core/error.hpp"

namespace kinectlab::simulate {

/// A number that an apparatus can be given. SI units; the unit stands at the end of the name.
struct ParameterRange {
    std::string_view name;
    double minimum;
    double maximum;
    double usual;  ///< where it is not given
};

using ParameterMap = std::map<std::string, double>;

/// All of `known`: as given, the others as usual. Errors name the parameter: one that `apparatus`
/// has not (with the nearest that it has), one out of its range, NaN.
[[nodiscard]] Result<ParameterMap> complete(
    std::string_view apparatus, std::span<const ParameterRange> known, const ParameterMap& given
);

/// Refuses a number outside the range, and NaN, under the name `field`.
[[nodiscard]] Result<void> check_range(
    std::string_view field, double value, double minimum, double maximum
);

/// The shortest text that gives the same number again.
[[nodiscard]] std::string shortest_text(double value);

}  // namespace kinectlab::simulate
