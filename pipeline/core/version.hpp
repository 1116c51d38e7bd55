#pragma once

namespace kinectlab {

/// Of the program; part of every result's provenance. CMakeLists.txt takes it from here.
inline constexpr const char* kVersion = "0.1.0";

}  // namespace kinectlab
