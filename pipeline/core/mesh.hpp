#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace kinectlab {

/// An object's surface in its own frame, metres: triangles, or points alone where there are none.
/// Holes, triangles turned either way and points that nobody uses are fine; every index is below
/// vertices.size() and every coordinate finite, whoever makes one sees to that.
struct TriangleMesh {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    [[nodiscard]] bool is_cloud() const { return triangles.empty(); }
};

}  // namespace kinectlab
