#pragma once

#include <algorithm>
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

/// The name that somebody who typed `given` most likely meant; empty if there are no names. Of
/// names that begin as `given` does the letters that are missing hardly count.
inline std::string nearest_name(std::string_view given, const std::vector<std::string>& names) {
    const std::string_view word = given.substr(0, 64);  // a whole pasted file is no misspelling
    std::string best;
    std::size_t best_distance = 0;
    for (const auto& name : names) {
        const bool begins_so = word.size() >= 3 && name.compare(0, word.size(), word) == 0;
        const std::size_t distance = begins_so ? 1 : edit_distance(word, name);
        if (!best.empty() && distance >= best_distance) continue;
        best = name;
        best_distance = distance;
    }
    return best;
}

}  // namespace kinectlab
