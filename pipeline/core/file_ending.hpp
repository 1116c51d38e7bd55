#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace kinectlab {

/// ".csv" of "Run.CSV": what kind of file a name says it is, in small letters.
inline std::string file_ending(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return ending;
}

}  // namespace kinectlab
