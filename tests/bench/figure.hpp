#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kinectlab::bench {

enum class Better { lower, higher };

/// One number that the project claims, beside what it has to reach and beside its peer.
struct Figure {
    std::string name;
    double value = 0.0;
    std::string unit;
    std::optional<double> bound;    ///< nothing: the number is only reported
    Better better = Better::lower;  ///< which side of the bound is good
    std::optional<double> peer;     ///< the same quantity of the stock way, in the same unit
    std::string peer_name;

    [[nodiscard]] std::optional<bool> met() const {
        if (!bound) return std::nullopt;
        return better == Better::lower ? value <= *bound : value >= *bound;
    }
    /// How many times better than the peer.
    [[nodiscard]] std::optional<double> ratio() const {
        if (!peer || value == 0.0 || *peer == 0.0) return std::nullopt;
        return better == Better::lower ? *peer / value : value / *peer;
    }
};

using Figures = std::vector<Figure>;

}  // namespace kinectlab::bench
