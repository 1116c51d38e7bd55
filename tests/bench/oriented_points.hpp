#pragma once

#include <vector>

#include <Eigen/Core>

namespace kinectlab::bench {

/// Points of a surface with its outward normals, m; what the peers that recognise objects take.
struct OrientedPoints {
    std::vector<Eigen::Vector3f> points, normals;
};

}  // namespace kinectlab::bench
