#pragma once

#include <string>
#include <vector>

namespace kinectlab::plots {

/// From the least to the greatest value of an axis, and where its marks stand.
struct Axis {
    double low = 0.0;
    double high = 1.0;
    double step = 0.2;  ///< between marks: 1, 2 or 5 times a power of ten

    [[nodiscard]] std::vector<double> marks() const;
    /// As many digits as the step needs, no more; "1.5e-6" where plain numbers would be long.
    [[nodiscard]] std::string label(double mark) const;
};

/// An axis that holds both with a margin, with about `wanted` marks. One value alone gets room
/// around it; low and high must be finite.
[[nodiscard]] Axis axis_for(double low, double high, int wanted);

}  // namespace kinectlab::plots
