#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape_support.hpp"

namespace kinectlab {

/// The coarse grid of a picture on which a scene's points and shapes are neighbours: one oriented
/// point for each cell. Stands for the octree and the bitmaps of Schnabel et al. 2007. Keeps its
/// buffers.
class ShapeGrid {
public:
    static constexpr int kCell = 4;  ///< px

    explicit ShapeGrid(const Pinhole& camera);

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] std::size_t cells() const { return point_of_.size(); }
    [[nodiscard]] std::size_t cell_of(std::uint32_t pixel) const {
        return pixel / width_ / kCell * static_cast<std::size_t>(columns_) + pixel % width_ / kCell;
    }
    /// A pixel in the middle of each cell, in a random order that is the same in every run.
    [[nodiscard]] std::vector<std::uint32_t> shuffled_pixels() const;

    /// Enters the points that are looked up from now on.
    void index(const SurfacePoints& points);
    /// Index of a cell's point, -1 for none.
    [[nodiscard]] std::int32_t point_in(std::size_t cell) const { return point_of_[cell]; }

    /// The largest connected part of a shape's support, as cells; valid until the next call.
    std::span<const std::uint32_t> find_component(
        const Shape& shape, const SurfacePoints& points, const Tolerance& tolerance
    );
    /// Pixels with a reading, not taken, in the component's cells and those within `grow` cells of
    /// it, in reading order.
    void collect_pixels(
        const DisparityImage& image,
        std::span<const std::uint8_t> taken,
        int grow,
        std::vector<std::uint32_t>& pixels
    );
    /// The component's points, so many at most.
    void collect_points(const SurfacePoints& points, std::size_t most, SurfacePoints& own);

private:
    std::uint32_t width_;
    int height_, columns_, rows_;
    std::vector<std::int32_t> point_of_;
    std::vector<std::uint8_t> holds_, mark_;
    std::vector<std::uint32_t> stack_, component_, largest_;  // cells
};

}  // namespace kinectlab
