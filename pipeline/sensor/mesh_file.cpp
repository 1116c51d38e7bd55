#include "pipeline/sensor/mesh_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/core/file_ending.hpp"
#include "pipeline/sensor/file_bytes.hpp"
#include "pipeline/sensor/mesh_text.hpp"
#include "pipeline/sensor/pcd_file.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kMaxMeshBytes = 512U << 20U;

}  // namespace

namespace mesh {

Result<MeshFile> tidied(TriangleMesh mesh, const std::string& name) {
    constexpr auto kGone = std::numeric_limits<std::uint32_t>::max();
    MeshFile file;
    std::vector<std::uint32_t> place(mesh.vertices.size(), kGone);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (!mesh.vertices[i].allFinite()) continue;
        place[i] = static_cast<std::uint32_t>(file.mesh.vertices.size());
        file.mesh.vertices.push_back(mesh.vertices[i]);
    }
    file.dropped_vertices = mesh.vertices.size() - file.mesh.vertices.size();
    for (const auto& corners : mesh.triangles) {
        std::array<std::uint32_t, 3> moved{};
        bool whole = true;
        for (std::size_t k = 0; k < 3; ++k) {
            if (corners[k] >= place.size())
                return fail(
                    ErrorCode::bad_data,
                    name,
                    "has a face with vertex " + std::to_string(corners[k]) + " (counted from 0)",
                    "the file has " + std::to_string(place.size()) + " vertices"
                );
            moved[k] = place[corners[k]];
            whole = whole && moved[k] != kGone;
        }
        if (whole) {
            const Eigen::Vector3d a = file.mesh.vertices[moved[0]].cast<double>();
            const Eigen::Vector3d b = file.mesh.vertices[moved[1]].cast<double>() - a;
            const Eigen::Vector3d c = file.mesh.vertices[moved[2]].cast<double>() - a;
            whole = b.cross(c).norm() > 1e-9 * (b.squaredNorm() + c.squaredNorm());
        }
        if (whole) file.mesh.triangles.push_back(moved);
    }
    file.dropped_triangles = mesh.triangles.size() - file.mesh.triangles.size();
    if (file.mesh.vertices.empty())
        return fail(
            ErrorCode::bad_data,
            name,
            file.dropped_vertices == 0
                ? std::string("holds no points")
                : "holds no point that is one: all " + std::to_string(file.dropped_vertices) +
                      " have coordinates that are NaN or infinite",
            "give a model with a surface"
        );
    if (file.mesh.triangles.empty() && file.dropped_triangles > 0)
        return fail(
            ErrorCode::bad_data,
            name,
            "holds no triangle with an area, only " + std::to_string(file.dropped_triangles) +
                " without",
            "give a model with a surface"
        );
    return file;
}

}  // namespace mesh

Result<MeshFile> parse_pcd_points(std::span<const std::uint8_t> file, const std::string& name) {
    const auto cloud = parse_pcd(file, name, PcdShape::any);
    if (!cloud) return tl::unexpected<Error>(cloud.error());
    TriangleMesh mesh;
    mesh.vertices.reserve(cloud->x.size());
    for (std::size_t i = 0; i < cloud->x.size(); ++i)
        if (!std::isnan(cloud->x[i]) || !std::isnan(cloud->y[i]) || !std::isnan(cloud->z[i]))
            mesh.vertices.emplace_back(cloud->x[i], cloud->y[i], cloud->z[i]);
    if (mesh.vertices.empty())
        return fail(
            ErrorCode::bad_data,
            name,
            "holds no reading: all " + std::to_string(cloud->x.size()) + " points are NaN",
            "give a cloud in which the thing is seen"
        );
    return mesh::tidied(std::move(mesh), name);
}

Result<MeshFile> read_mesh(const std::filesystem::path& file) {
    const std::string ending = file_ending(file);
    const auto parse = ending == ".ply"   ? parse_ply
                       : ending == ".obj" ? parse_obj
                       : ending == ".stl" ? parse_stl
                       : ending == ".pcd" ? parse_pcd_points
                                          : nullptr;
    if (parse == nullptr)
        return fail(
            ErrorCode::invalid_argument,
            file.string(),
            "is no kind of model that is read here",
            "give a .ply, .obj, .stl or .pcd file"
        );
    std::vector<std::uint8_t> bytes;
    if (auto read = read_file(file, kMaxMeshBytes, bytes); !read)
        return tl::unexpected<Error>(read.error());
    return parse(bytes, file.string());
}

}  // namespace kinectlab
