#include "pipeline/track/shape_grid.hpp"

#include <algorithm>

#include "pipeline/track/shape_search.hpp"

namespace kinectlab {

ShapeGrid::ShapeGrid(const Pinhole& camera)
    : width_(static_cast<std::uint32_t>(camera.width)),
      height_(camera.height),
      columns_((camera.width + kCell - 1) / kCell),
      rows_((camera.height + kCell - 1) / kCell) {
    const auto cells = static_cast<std::size_t>(columns_ * rows_);
    point_of_.resize(cells);
    mark_.resize(cells);
    holds_.resize(cells + SurfacePoints::kLanes);
    stack_.reserve(cells);
    component_.reserve(cells);
    largest_.reserve(cells);
}

std::vector<std::uint32_t> ShapeGrid::shuffled_pixels() const {
    std::vector<std::uint32_t> order;
    const int width = static_cast<int>(width_);
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            const int u = std::min(kCell * column + kCell / 2, width - 1);
            const int v = std::min(kCell * row + kCell / 2, height_ - 1);
            order.push_back(static_cast<std::uint32_t>(v * width + u));
        }
    ShapeRandom shuffle;
    for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[shuffle.below(i)]);
    return order;
}

void ShapeGrid::index(const SurfacePoints& points) {
    std::fill(point_of_.begin(), point_of_.end(), -1);
    for (std::size_t i = 0; i < points.size; ++i)
        point_of_[cell_of(points.pixel[i])] = static_cast<std::int32_t>(i);
}

std::span<const std::uint32_t> ShapeGrid::find_component(
    const Shape& shape, const SurfacePoints& points, const Tolerance& tolerance
) {
    mark_support(shape, points, tolerance, holds_);
    std::fill(mark_.begin(), mark_.end(), std::uint8_t{0});
    for (std::size_t i = 0; i < points.size; ++i)
        if (holds_[i] != 0) mark_[cell_of(points.pixel[i])] = 1;
    largest_.clear();
    for (std::size_t start = 0; start < mark_.size(); ++start) {
        if (mark_[start] != 1) continue;
        component_.clear();
        stack_.assign(1, static_cast<std::uint32_t>(start));
        mark_[start] = 2;
        while (!stack_.empty()) {
            const auto cell = static_cast<int>(stack_.back());
            stack_.pop_back();
            component_.push_back(static_cast<std::uint32_t>(cell));
            const int column = cell % columns_, row = cell / columns_;
            for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r)
                for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1);
                     ++c) {
                    const auto next = static_cast<std::size_t>(r * columns_ + c);
                    if (mark_[next] != 1) continue;
                    mark_[next] = 2;
                    stack_.push_back(static_cast<std::uint32_t>(next));
                }
        }
        if (component_.size() > largest_.size()) largest_.swap(component_);
    }
    return largest_;
}

void ShapeGrid::collect_pixels(
    const DisparityImage& image,
    std::span<const std::uint8_t> taken,
    int grow,
    std::vector<std::uint32_t>& pixels
) {
    std::fill(mark_.begin(), mark_.end(), std::uint8_t{0});
    for (const auto cell : largest_) {
        const int column = static_cast<int>(cell) % columns_;
        const int row = static_cast<int>(cell) / columns_;
        for (int r = std::max(0, row - grow); r <= std::min(rows_ - 1, row + grow); ++r)
            for (int c = std::max(0, column - grow); c <= std::min(columns_ - 1, column + grow);
                 ++c)
                mark_[static_cast<std::size_t>(r * columns_ + c)] = 1;
    }
    const int width = static_cast<int>(width_);
    pixels.clear();
    for (int v = 0; v < height_; ++v) {
        const float* row = image.row(v);
        const auto* marks = mark_.data() + static_cast<std::ptrdiff_t>(v / kCell) * columns_;
        for (int column = 0; column < columns_; ++column) {
            if (marks[column] == 0) continue;
            const int end = std::min(kCell * (column + 1), width);
            for (int u = kCell * column; u < end; ++u) {
                const auto pixel = static_cast<std::uint32_t>(v * width + u);
                if (row[u] > 0.0F && taken[pixel] == 0) pixels.push_back(pixel);
            }
        }
    }
}

void ShapeGrid::collect_points(const SurfacePoints& points, std::size_t most, SurfacePoints& own) {
    std::fill(mark_.begin(), mark_.end(), std::uint8_t{0});
    for (const auto cell : largest_)
        mark_[cell] = 1;
    own.clear();
    for (std::size_t i = 0; i < points.size && own.size < most; ++i)
        if (mark_[cell_of(points.pixel[i])] != 0) own.copy(points, i);
    own.pad();
}

}  // namespace kinectlab
