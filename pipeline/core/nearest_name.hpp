#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace kinectlab {

/// Letters to insert, delete, replace or swap with their neighbour to turn one word into the other
/// (optimal string alignment).
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> above(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(above.begin(), above.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = a[i - 1] == b[j - 1];
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(above);
        above.swap(row);
    }
    return above[b.size()];
}

/// What a name is called elsewhere. Only a name that is asked for is ever suggested.
inline constexpr std::array<std::array<std::string_view, 2>, 12> kOtherNames{{
    {"sor", "statistical"},  // PCL's filter
    {"voxel", "octree"},
    {"voxels", "octree"},
    {"grid", "image_grid"},
    {"ball", "sphere"},
    {"tube", "cylinder"},
    {"can", "cylinder"},
    {"model", "surface_patch"},
    {"mesh", "surface_patch"},
    {"motion", "change"},
    {"background", "reference"},
    {"off", "none"},
}};

/// "mls" of "moving_least_squares".
inline std::string initials(std::string_view name) {
    std::string letters;
    for (std::size_t i = 0; i < name.size(); ++i)
        if (name[i] != '_' && (i == 0 || name[i - 1] == '_')) letters += name[i];
    return letters;
}

/// The name that somebody who typed `given` most likely meant; empty if none is near enough: one
/// letter wrong in three, the beginning of a name, its initials, or what it is called elsewhere.
inline std::string nearest_name(std::string_view given, const std::vector<std::string>& names) {
    std::string word(given.substr(0, 64));  // a whole pasted file is no misspelling
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) {
        return c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(c));
    });
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const auto& name : names) {
        std::string small = name;
        std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) {
            return static_cast<char>(std::tolower(c));
        });
        const std::array<std::string_view, 2> other{word, small};
        const bool known =
            (word.size() >= 2 && initials(small) == word) ||
            std::find(kOtherNames.begin(), kOtherNames.end(), other) != kOtherNames.end();
        const bool begins_so = word.size() >= 3 && small.compare(0, word.size(), word) == 0;
        const std::size_t distance = known ? 0 : begins_so ? 1 : edit_distance(word, small);
        if (distance >= best_distance || distance >= small.size()) continue;
        best = name;
        best_distance = distance;
    }
    return best;
}

/// "did you mean sphere? Valid: change, sphere", or the valid names alone where none is near.
inline std::string did_you_mean(std::string_view given, const std::vector<std::string>& names) {
    const std::string near = nearest_name(given, names);
    std::string text = near.empty() ? "valid: " : "did you mean " + near + "? Valid: ";
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : ", ") + names[i];
    return text;
}

}  // namespace kinectlab
