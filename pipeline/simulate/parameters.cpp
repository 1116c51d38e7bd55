#include "pipeline/simulate/parameters.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "pipeline/core/nearest_name.hpp"

namespace kinectlab::simulate {

std::string shortest_text(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

Result<void> check_range(std::string_view field, double value, double minimum, double maximum) {
    if (value >= minimum && value <= maximum) return {};
    return fail(
        ErrorCode::invalid_argument,
        std::string(field),
        "is " + shortest_text(value),
        "give a number from " + shortest_text(minimum) + " to " + shortest_text(maximum)
    );
}

Result<ParameterMap> complete(
    std::string_view apparatus, std::span<const ParameterRange> known, const ParameterMap& given
) {
    for (const auto& [name, value] : given) {
        const auto is_it = [&name = name](const ParameterRange& range) {
            return range.name == name;
        };
        if (std::any_of(known.begin(), known.end(), is_it)) continue;
        std::vector<std::string> names;
        for (const auto& range : known)
            names.emplace_back(range.name);
        return fail(
            ErrorCode::invalid_argument,
            name,
            "is not a parameter of the " + std::string(apparatus),
            did_you_mean(name, names)
        );
    }
    ParameterMap all;
    for (const auto& range : known) {
        const auto found = given.find(std::string(range.name));
        const double value = found == given.end() ? range.usual : found->second;
        if (auto ok = check_range(range.name, value, range.minimum, range.maximum); !ok)
            return tl::unexpected(ok.error());
        all.emplace(range.name, value);
    }
    return all;
}

}  // namespace kinectlab::simulate
