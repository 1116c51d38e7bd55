#include "pipeline/track/object_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include <Eigen/Eigenvalues>

#include "pipeline/core/number_text.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kMostPlates = 5000;
constexpr std::size_t kFewestPoints = 20;
constexpr double kPlateHalfSide = 0.8;  // of the grid's cell: plates overlap a little
constexpr double kNeighbourhood = 2.0;  // cells, for a point's normal

/// Points of one cell of a grid of cubes, as their mean.
struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::uint32_t count = 0;
    std::uint32_t place = 0;
};

class Grid {
public:
    Grid(const std::vector<Eigen::Vector3f>& points, double cell_m)
        : cell_m_(cell_m), of_point_(points.size()) {
        std::unordered_map<std::uint64_t, std::uint32_t> places;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto [at, is_new] = places.try_emplace(
                key_of(points[i].cast<double>()), static_cast<std::uint32_t>(cells_.size())
            );
            if (is_new) cells_.emplace_back();
            auto& cell = cells_[at->second];
            cell.sum += points[i].cast<double>();
            ++cell.count;
            of_point_[i] = at->second;
        }
    }

    [[nodiscard]] std::vector<Eigen::Vector3f> means() const {
        std::vector<Eigen::Vector3f> means;
        means.reserve(cells_.size());
        for (const auto& cell : cells_)
            means.emplace_back((cell.sum / cell.count).cast<float>());
        return means;
    }
    [[nodiscard]] std::uint32_t cell_of(std::uint32_t point) const { return of_point_[point]; }
    [[nodiscard]] std::size_t size() const { return cells_.size(); }

private:
    [[nodiscard]] std::uint64_t key_of(const Eigen::Vector3d& p) const {
        std::uint64_t key = 0;
        for (int k = 0; k < 3; ++k)
            key = key << 21U |
                  (static_cast<std::uint64_t>(std::llround(p[k] / cell_m_) + (1LL << 20)) &
                   0x1FFFFFU);
        return key;
    }

    double cell_m_;
    std::vector<std::uint32_t> of_point_;
    std::vector<Cell> cells_;
};

/// Vertices of one cell become one; triangles that collapse go.
void simplify(ObjectModel& model, double cell_m) {
    const Grid grid(model.vertices, cell_m);
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (const auto& corners : model.triangles) {
        const std::array<std::uint32_t, 3> moved{
            grid.cell_of(corners[0]), grid.cell_of(corners[1]), grid.cell_of(corners[2])};
        if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0])
            kept.push_back(moved);
    }
    model.vertices = grid.means();
    model.triangles = std::move(kept);
}

/// The direction in which a point's neighbours spread least; nothing where they lie on a line.
std::optional<Eigen::Matrix3d> axes_at(
    const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& at, float reach
) {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (const auto& point : points) {
        const Eigen::Vector3f off = point - at;
        if (off.squaredNorm() > reach * reach) continue;
        scatter += off.cast<double>() * off.cast<double>().transpose();
        sum += off.cast<double>();
        ++count;
    }
    if (count < 4) return std::nullopt;
    scatter -= sum * sum.transpose() / count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(scatter);
    if (solved.eigenvalues()[1] < 0.02 * solved.eigenvalues()[2]) return std::nullopt;
    return solved.eigenvectors();  // ascending: the normal first
}

/// Each point becomes a square plate across its normal.
void make_plates(ObjectModel& model) {
    double cell_m = model.radius_m / 60.0;
    for (;; cell_m *= 1.3) {
        const Grid grid(model.vertices, cell_m);
        if (grid.size() > kMostPlates) continue;
        // A sparse scan has fewer points than cells: its plates must still meet.
        const double spacing =
            std::max(cell_m, 2.0 * model.radius_m / std::sqrt(static_cast<double>(grid.size())));
        cell_m = std::min(spacing, 1.5 * cell_m);
        model.vertices = grid.means();
        break;
    }
    const std::vector<Eigen::Vector3f> points = std::move(model.vertices);
    model.vertices = {};
    for (const auto& point : points) {
        const auto axes = axes_at(points, point, static_cast<float>(kNeighbourhood * cell_m));
        if (!axes) continue;
        const Eigen::Vector3f a = (kPlateHalfSide * cell_m * axes->col(1)).cast<float>();
        const Eigen::Vector3f b = (kPlateHalfSide * cell_m * axes->col(2)).cast<float>();
        const auto first = static_cast<std::uint32_t>(model.vertices.size());
        for (const Eigen::Vector3f& corner :
             {Eigen::Vector3f(-a - b),
              Eigen::Vector3f(a - b),
              Eigen::Vector3f(a + b),
              Eigen::Vector3f(b - a)})
            model.vertices.push_back(point + corner);
        model.triangles.push_back({first, first + 1, first + 2});
        model.triangles.push_back({first, first + 2, first + 3});
    }
}

void find_normals(ObjectModel& model) {
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (const auto& corners : model.triangles) {
        const Eigen::Vector3d a = model.vertices[corners[0]].cast<double>();
        const Eigen::Vector3d normal = (model.vertices[corners[1]].cast<double>() - a)
                                           .cross(model.vertices[corners[2]].cast<double>() - a);
        if (!(normal.norm() > 1e-14)) continue;
        kept.push_back(corners);
        model.normals.emplace_back(normal.normalized().cast<float>());
    }
    model.triangles = std::move(kept);
}

/// The middle of the box about all points, and the radius from there.
void centre(ObjectModel& model, const TriangleMesh& mesh, double metres_per_unit) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const auto& vertex : mesh.vertices) {
        low = low.cwiseMin(metres_per_unit * vertex.cast<double>());
        high = high.cwiseMax(metres_per_unit * vertex.cast<double>());
    }
    model.centre_obj = (low + high) / 2.0;
    for (const auto& vertex : mesh.vertices) {
        const Eigen::Vector3d off = metres_per_unit * vertex.cast<double>() - model.centre_obj;
        model.vertices.emplace_back(off.cast<float>());
        model.radius_m = std::max(model.radius_m, off.norm());
    }
}

}  // namespace

Result<ObjectModel> make_object_model(const TriangleMesh& mesh, double metres_per_unit) {
    const auto empty = [&](const std::string& what) {
        return fail(
            ErrorCode::bad_data, "model", what, "give a model with a surface, its size in metres"
        );
    };
    if (mesh.vertices.empty()) return empty("has no points");
    if (!(std::isfinite(metres_per_unit) && metres_per_unit > 0.0))
        return empty("is scaled by " + number_text(metres_per_unit));
    ObjectModel model;
    centre(model, mesh, metres_per_unit);
    if (!(model.radius_m > 1e-4 && model.radius_m < 1e6))
        return empty("has a radius of " + number_text(model.radius_m) + " m");
    if (mesh.is_cloud()) {
        if (mesh.vertices.size() < kFewestPoints)
            return empty("has only " + std::to_string(mesh.vertices.size()) + " points");
        make_plates(model);
    } else {
        model.has_outline = true;
        model.triangles = mesh.triangles;
        for (double cell_m = model.radius_m / 100.0; model.triangles.size() > kMostModelTriangles;
             cell_m *= 1.3)
            simplify(model, cell_m);
    }
    find_normals(model);
    if (model.triangles.empty()) return empty("has no surface: all its points lie on lines");
    return model;
}

}  // namespace kinectlab
