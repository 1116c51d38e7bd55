#include "pipeline/sensor/mesh_text.hpp"

namespace kinectlab {
namespace {

using namespace mesh;

constexpr std::size_t kMaxCorners = 255;

bool take_vertex(std::string_view line, TriangleMesh& out) {
    Eigen::Vector3f vertex;
    for (int k = 0; k < 3; ++k) {
        const auto value = to_number<float>(take_word(line));
        if (!value) return false;
        vertex[k] = *value;
    }
    out.vertices.push_back(vertex);
    return true;
}

// "7", "7/1", "7//3" or "-1": only the vertex counts. Nothing if it is none of those seen so far.
std::optional<std::uint32_t> to_index(std::string_view word, std::size_t vertices) {
    const auto number = to_number<std::int64_t>(word.substr(0, word.find('/')));
    if (!number) return std::nullopt;
    const auto count = static_cast<std::int64_t>(vertices);
    const std::int64_t index = *number > 0 ? *number - 1 : count + *number;
    if (*number == 0 || index < 0 || index >= count) return std::nullopt;
    return static_cast<std::uint32_t>(index);
}

bool take_face(std::string_view line, TriangleMesh& out) {
    std::array<std::uint32_t, 3> fan{};
    std::size_t corners = 0;
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
        const auto index = to_index(word, out.vertices.size());
        if (!index || ++corners > kMaxCorners) return false;
        if (corners == 1) fan[0] = *index;
        if (corners > 2) out.triangles.push_back({fan[0], fan[1], *index});
        fan[1] = *index;
    }
    return corners >= 3;
}

}  // namespace

Result<MeshFile> parse_obj(std::span<const std::uint8_t> file, const std::string& name) {
    TriangleMesh out;
    Text text(file);
    for (std::string_view line; text.next_line(line);) {
        const std::string_view whole = line;
        const auto key = take_word(line);
        if (key == "v" && !take_vertex(line, out))
            return bad_line(
                name, text.line_number(), "is no vertex: " + shown(whole), "give v and 3 numbers"
            );
        if (key == "f" && !take_face(line, out))
            return bad_line(
                name,
                text.line_number(),
                "is no face of the " + std::to_string(out.vertices.size()) +
                    " vertices above it: " + shown(whole),
                "give f and 3 to 255 of their numbers, counted from 1"
            );
        if (out.vertices.size() > kMaxMeshVertices || out.triangles.size() > kMaxMeshTriangles)
            return bad_line(
                name,
                text.line_number(),
                "is beyond " + std::to_string(kMaxMeshVertices) + " vertices or triangles",
                "simplify the model"
            );
    }
    return tidied(std::move(out), name);
}

}  // namespace kinectlab
