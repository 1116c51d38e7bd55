#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/error.hpp"
#include "pipeline/core/mesh.hpp"

namespace kinectlab {

/// An object's surface made ready to be looked at from anywhere: about its own centre, with no more
/// triangles than a frame has time for. A cloud of points became small plates across their normals.
struct ObjectModel {
    std::vector<Eigen::Vector3f> vertices;  ///< m, from the centre
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Eigen::Vector3f> normals;                  ///< of the triangles, either way round
    Eigen::Vector3d centre_obj = Eigen::Vector3d::Zero();  ///< in the model's own frame, m
    double radius_m = 0.0;  ///< of the sphere about the centre that holds all of it
    /// Whether the surface ends in the picture where the object ends: a mesh's does, but a cloud
    /// ends where its scan ended.
    bool has_outline = false;
};

/// Triangles for which there is time in a frame; larger meshes are simplified on the finest grid
/// that leaves no more.
inline constexpr std::size_t kMostModelTriangles = 12'000;

/// `metres_per_unit` scales the mesh. An error without two triangles' worth of surface: fewer than
/// 20 points of a cloud, all on a line, or nothing left at the scale given.
[[nodiscard]] Result<ObjectModel> make_object_model(
    const TriangleMesh& mesh, double metres_per_unit = 1.0
);

}  // namespace kinectlab
