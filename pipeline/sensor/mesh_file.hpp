#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/core/mesh.hpp"

namespace kinectlab {

/// More than this is refused: a thing that a Kinect can tell apart needs thousands.
inline constexpr std::size_t kMaxMeshVertices = 4'000'000;
inline constexpr std::size_t kMaxMeshTriangles = 4'000'000;

/// What a file held, in its own unit.
struct MeshFile {
    TriangleMesh mesh;
    std::size_t dropped_vertices = 0;   ///< coordinates that are no finite numbers
    std::size_t dropped_triangles = 0;  ///< without area, or with a dropped corner
};

// `name` stands in errors. Damaged and truncated files, indices beyond the vertices and files
// without a single point are errors; memory is only taken for what the file's size can hold.

/// PLY, ascii and binary of either byte order; faces of up to 255 corners become fans of triangles,
/// other elements and properties are passed over.
[[nodiscard]] Result<MeshFile> parse_ply(
    std::span<const std::uint8_t> file, const std::string& name
);

/// Wavefront OBJ: v and f lines (indices from 1, negative ones from the end), everything else is
/// passed over.
[[nodiscard]] Result<MeshFile> parse_obj(
    std::span<const std::uint8_t> file, const std::string& name
);

/// STL, ascii and binary; told apart by the size that a binary file must have, because many binary
/// files begin with "solid" too. Equal corners become one vertex.
[[nodiscard]] Result<MeshFile> parse_stl(
    std::span<const std::uint8_t> file, const std::string& name
);

/// The points of a PCD file, organised or not; points without a reading are left out.
[[nodiscard]] Result<MeshFile> parse_pcd_points(
    std::span<const std::uint8_t> file, const std::string& name
);

/// By the file name's ending: .ply, .obj, .stl or .pcd, at most 512 MiB.
[[nodiscard]] Result<MeshFile> read_mesh(const std::filesystem::path& file);

/// What a person should know of a model before it is used: sizes that look like another unit,
/// holes, what was left out. Empty if there is nothing to say. `metres_per_unit` as it will be
/// used.
[[nodiscard]] std::vector<std::string> mesh_warnings(
    const MeshFile& file, const std::string& name, double metres_per_unit
);

}  // namespace kinectlab
