#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <map>

#include "pipeline/sensor/mesh_file.hpp"

namespace kinectlab {
namespace {

constexpr double kHugeM = 5.0;    // nothing larger is seen whole by a Kinect
constexpr double kTinyM = 0.005;  // nothing smaller is seen at all

struct Unit {
    const char* name;
    double metres;
};
constexpr Unit kUnits[] = {{"millimetres", 0.001}, {"centimetres", 0.01}, {"inches", 0.0254}};
constexpr double kHandSized[] = {0.04, 1.0};  // m, of things that are put before a Kinect

Eigen::Vector3d size_of(const TriangleMesh& mesh) {
    Eigen::Vector3f low = mesh.vertices.front(), high = low;
    for (const auto& vertex : mesh.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
    }
    return (high - low).cast<double>();
}

std::string rounded(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string times(const Eigen::Vector3d& size) {
    return rounded(size.x()) + " x " + rounded(size.y()) + " x " + rounded(size.z());
}

/// Units in which a model of this size (in its own) is one that a hand can hold.
std::string likely_units(const Eigen::Vector3d& size) {
    std::string text;
    for (const auto& unit : kUnits) {
        const Eigen::Vector3d in_metres = size * unit.metres;
        const double largest = in_metres.maxCoeff();
        if (largest < kHandSized[0] || largest > kHandSized[1]) continue;
        text += (text.empty() ? "" : ", or ") + std::string(unit.name) + " (" + times(in_metres) +
                " m): set model_unit_m to " + rounded(unit.metres);
    }
    return text;
}

/// Sides of triangles, and how many of them belong to one triangle alone. Vertices in one place
/// count as one, since many files repeat them for each face.
std::array<std::size_t, 2> edges_and_open_ones(const TriangleMesh& mesh) {
    using Place = std::array<float, 3>;
    std::map<Place, std::uint32_t> places;
    const auto name_of = [&](std::uint32_t vertex) {
        const auto& p = mesh.vertices[vertex];
        const auto fresh = static_cast<std::uint32_t>(places.size());
        return places.try_emplace({p.x(), p.y(), p.z()}, fresh).first->second;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (const auto& corners : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = name_of(corners[k]), b = name_of(corners[(k + 1) % 3]);
            ++sides[std::minmax(a, b)];
        }
    const auto open = std::count_if(sides.begin(), sides.end(), [](const auto& side) {
        return side.second == 1;
    });
    return {sides.size(), static_cast<std::size_t>(open)};
}

}  // namespace

std::vector<std::string> mesh_warnings(
    const MeshFile& file, const std::string& name, double metres_per_unit
) {
    std::vector<std::string> warnings;
    if (file.dropped_vertices > 0 || file.dropped_triangles > 0)
        warnings.push_back(
            name + ": left out " + std::to_string(file.dropped_vertices) +
            " points that are not finite and " + std::to_string(file.dropped_triangles) +
            " triangles without an area"
        );
    if (file.mesh.vertices.empty()) return warnings;
    const Eigen::Vector3d own_size = size_of(file.mesh);
    const Eigen::Vector3d size = own_size * metres_per_unit;
    const double largest = size.maxCoeff();
    if (largest > kHugeM) {
        const std::string likely = likely_units(own_size);
        warnings.push_back(
            name + ": the model is " + times(size) + " m, more than a Kinect sees; " +
            (likely.empty() ? "set model_unit_m to the metres in one of its units"
                            : "perhaps it is in " + likely)
        );
    }
    if (largest < kTinyM)
        warnings.push_back(
            name + ": the model is " + times(size) + " m, too small to be seen; is model_unit_m " +
            rounded(metres_per_unit) + " right?"
        );
    const auto [edges, open] = edges_and_open_ones(file.mesh);
    if (open > 0)
        warnings.push_back(
            name + ": the surface has holes, " + std::to_string(open) + " of " +
            std::to_string(edges) +
            " edges belong to one triangle only; where it is open the thing is not recognised, so "
            "close it if the thing has a surface there"
        );
    return warnings;
}

}  // namespace kinectlab
