#pragma once

#include <array>
#include <charconv>
#include <string>

namespace kinectlab {

/// A number as a person writes it in a message: 0, 5000, 0.2, 1e+20; at most seven digits.
inline std::string number_text(double value) {
    std::array<char, 32> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 7)
            .ptr;
    return {text.data(), end};
}

}  // namespace kinectlab
