#include <cstring>
#include <unordered_map>

#include "pipeline/sensor/mesh_text.hpp"

namespace kinectlab {
namespace {

using namespace mesh;

constexpr std::size_t kHead = 84;   // 80 bytes of anything, then the number of facets
constexpr std::size_t kFacet = 50;  // normal, three corners, two bytes of anything
constexpr std::size_t kNormal = 12;

/// An STL file repeats each corner in every facet that uses it.
class Corners {
public:
    explicit Corners(TriangleMesh& mesh) : mesh_(mesh) {}

    std::uint32_t index_of(const Eigen::Vector3f& corner) {
        const auto [found, is_new] =
            known_.try_emplace(corner, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (is_new) mesh_.vertices.push_back(corner);
        return found->second;
    }

private:
    struct Hash {
        std::size_t operator()(const Eigen::Vector3f& p) const {
            std::uint64_t hash = 1469598103934665603U;
            for (int k = 0; k < 3; ++k)
                hash = (hash ^ std::hash<float>()(p[k])) * 1099511628211U;
            return static_cast<std::size_t>(hash ^ (hash >> 29U));
        }
    };
    struct Same {  // by value, except that a NaN is itself
        bool operator()(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const {
            return a == b || std::memcmp(a.data(), b.data(), sizeof(float) * 3) == 0;
        }
    };
    TriangleMesh& mesh_;
    std::unordered_map<Eigen::Vector3f, std::uint32_t, Hash, Same> known_;
};

std::uint32_t facets_of(std::span<const std::uint8_t> file) {
    std::uint32_t facets = 0;
    std::memcpy(&facets, file.data() + kHead - 4, 4);
    return facets;
}

bool is_ascii(std::span<const std::uint8_t> file) {
    if (file.size() >= kHead && file.size() == kHead + kFacet * std::size_t{facets_of(file)})
        return false;
    Text text(file);
    std::string_view line;
    while (text.next_line(line)) {
        const auto word = take_word(line);
        if (!word.empty()) return word == "solid";
    }
    return false;
}

tl::unexpected<Error> too_many(const std::string& name) {
    return fail(
        ErrorCode::bad_data,
        name,
        "has more than " + std::to_string(kMaxMeshTriangles) + " facets",
        "simplify the model"
    );
}

Result<MeshFile> parse_binary(std::span<const std::uint8_t> file, const std::string& name) {
    if (file.size() < kHead)
        return fail(
            ErrorCode::bad_data,
            name,
            "has " + std::to_string(file.size()) + " bytes and does not begin with \"solid\"",
            "a binary STL file has at least 84"
        );
    const std::size_t facets = facets_of(file);
    if (facets > (file.size() - kHead) / kFacet)
        return fail(
            ErrorCode::bad_data,
            name,
            "says it has " + std::to_string(facets) + " facets, its " +
                std::to_string(file.size()) + " bytes hold " +
                std::to_string((file.size() - kHead) / kFacet),
            "give the whole file"
        );
    if (facets > kMaxMeshTriangles) return too_many(name);
    TriangleMesh out;
    Corners corners(out);
    for (std::size_t i = 0; i < facets; ++i) {
        std::array<float, 9> numbers{};
        std::memcpy(numbers.data(), file.data() + kHead + i * kFacet + kNormal, sizeof(float) * 9);
        std::array<std::uint32_t, 3> facet{};
        for (std::size_t k = 0; k < 3; ++k)
            facet[k] = corners.index_of({numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]});
        out.triangles.push_back(facet);
    }
    return tidied(std::move(out), name);
}

Result<MeshFile> parse_ascii(std::span<const std::uint8_t> file, const std::string& name) {
    TriangleMesh out;
    Corners corners(out);
    std::array<std::uint32_t, 3> facet{};
    std::size_t in_facet = 0;
    Text text(file);
    for (std::string_view line; text.next_line(line);) {
        const auto key = take_word(line);
        if (key == "vertex") {
            Eigen::Vector3f corner;
            for (int k = 0; k < 3; ++k) {
                const auto word = take_word(line);
                const auto value = to_number<float>(word);
                if (!value || in_facet == 3)
                    return bad_line(
                        name,
                        text.line_number(),
                        value ? "is a fourth vertex of a facet"
                              : "has " + shown(word) + " as number",
                        "give three vertices a facet, three numbers a vertex"
                    );
                corner[k] = *value;
            }
            facet[in_facet++] = corners.index_of(corner);
        }
        if (key != "endfacet") continue;
        if (in_facet != 3)
            return bad_line(
                name,
                text.line_number(),
                "ends a facet of " + std::to_string(in_facet) + " vertices",
                "give three"
            );
        out.triangles.push_back(facet);
        in_facet = 0;
        if (out.triangles.size() > kMaxMeshTriangles) return too_many(name);
    }
    if (in_facet != 0)
        return bad_line(name, text.line_number(), "ends amid a facet", "give the whole file");
    return tidied(std::move(out), name);
}

}  // namespace

Result<MeshFile> parse_stl(std::span<const std::uint8_t> file, const std::string& name) {
    return is_ascii(file) ? parse_ascii(file, name) : parse_binary(file, name);
}

}  // namespace kinectlab
