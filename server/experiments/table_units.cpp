#include "server/experiments/table_units.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "server/experiments/table_text.hpp"

namespace kinectlab::experiments {
namespace {

struct Unit {
    std::string_view written;
    std::string_view unit;
    bool is_time;
    double scale;
};

// The µ is a sign of its own or the Greek letter, or one byte in Latin 1.
constexpr std::array<Unit, 16> kUnits{{
    {"s", "s", true, 1.0},
    {"sec", "s", true, 1.0},
    {"ms", "ms", true, 1e-3},
    {"us", "us", true, 1e-6},
    {"\xC2\xB5s", "us", true, 1e-6},
    {"\xCE\xBCs", "us", true, 1e-6},
    {"\xB5s", "us", true, 1e-6},
    {"ns", "ns", true, 1e-9},
    {"min", "min", true, 60.0},
    {"m", "m", false, 1.0},
    {"cm", "cm", false, 1e-2},
    {"mm", "mm", false, 1e-3},
    {"in", "in", false, 0.0254},
    {"px", "px", false, 1e-3},
    {"pixel", "px", false, 1e-3},
    {"pixels", "px", false, 1e-3},
}};

std::string in_small_letters(std::string_view text) {
    std::string small(text);
    std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return small;
}

/// Not of "x_in" or "t_min", which say as well where from and which.
bool is_sure_ending(std::string_view ending) {
    return ending != "in" && ending != "min" &&
           (known_unit(ending, true) || known_unit(ending, false));
}

}  // namespace

std::optional<std::string> known_unit(std::string_view written, bool is_time) {
    const std::string small = in_small_letters(written);
    for (const auto& unit : kUnits)
        if (unit.written == small && unit.is_time == is_time) return std::string(unit.unit);
    return std::nullopt;
}

double scale_of_unit(std::string_view unit) {
    const auto* const found = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& known) {
        return known.written == unit;
    });
    return found == kUnits.end() ? 1.0 : found->scale;
}

TableHead parse_head(std::string_view cell) {
    const auto text = bare_cell(cell);
    TableHead head{in_small_letters(text), {}, {}};
    const auto cut = [&](std::size_t name_end, std::size_t unit_begin, std::size_t unit_end) {
        head.name = in_small_letters(bare_cell(text.substr(0, name_end)));
        head.unit = bare_cell(text.substr(unit_begin, unit_end - unit_begin));
    };
    const auto open = text.find_last_of("([");
    const auto mark = text.find_last_of("/,");
    const auto underscore = text.rfind('_');
    if (open != text.npos) {
        const auto close = std::min(text.find_first_of(")]", open), text.size());
        cut(text.find_first_of("(["), open + 1, close);
    } else if (mark != text.npos) {
        cut(mark, mark + 1, text.size());
    } else if (underscore != text.npos && is_sure_ending(text.substr(underscore + 1))) {
        cut(underscore, underscore + 1, text.size());
    } else {
        head.name = head.whole;
    }
    return head;
}

}  // namespace kinectlab::experiments
