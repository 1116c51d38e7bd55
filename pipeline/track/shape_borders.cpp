#include "pipeline/track/shape_borders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kinectlab {
namespace {

constexpr std::size_t kMostShapes = 64;
constexpr int kAround = 2;         // px: a window of 5x5 readings decides
constexpr double kEndReach = 3.0;  // px beyond the ends

}  // namespace

double off_in_sigmas(
    const ShapeFit& fit,
    const DisparityImage& image,
    const Pinhole& camera,
    const DisparityScale& scale,
    std::uint32_t pixel
) {
    const auto width = static_cast<std::uint32_t>(camera.width);
    const Eigen::Vector3d ray = camera.ray(pixel % width, pixel / width);
    const double s = image.at(pixel);
    if (fit.shape.kind == ShapeKind::cylinder || fit.shape.kind == ShapeKind::cone) {
        const double reach = kEndReach * fit.shape.point.norm() / camera.fx;
        const double height = height_on(fit.shape, ray * scale.metres(s));
        if (height < fit.low - reach || height > fit.high + reach)
            return std::numeric_limits<double>::quiet_NaN();
    }
    return (s - meet(ray, fit.shape) / scale.inverse_depth_step) / scale.sigma_at(s);
}

ShapeBorders::ShapeBorders(const RgbdCamera& camera)
    : camera_(camera.depth),
      scale_(camera),
      columns_((camera.depth.width + kCell - 1) / kCell),
      rows_((camera.depth.height + kCell - 1) / kCell) {
    const auto pixels =
        static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
    owner_.resize(pixels);
    next_.resize(pixels);
    owners_.resize(static_cast<std::size_t>(columns_ * rows_));
}

void ShapeBorders::enter(std::span<const SceneShape> shapes) {
    std::fill(owner_.begin(), owner_.end(), -1);
    std::fill(owners_.begin(), owners_.end(), 0);
    const auto width = static_cast<std::uint32_t>(camera_.width);
    for (std::size_t i = 0; i < shapes.size(); ++i)
        for (const auto pixel : shapes[i].pixels) {
            owner_[pixel] = static_cast<std::int32_t>(i);
            const std::size_t cell =
                pixel / width / kCell * static_cast<std::size_t>(columns_) + pixel % width / kCell;
            owners_[cell] |= std::uint64_t{1} << i;
        }
    next_ = owner_;
}

std::uint64_t ShapeBorders::owners_near(int column, int row) const {
    std::uint64_t found = 0;
    for (int r = std::max(0, row - kNearCells); r <= std::min(rows_ - 1, row + kNearCells); ++r)
        for (int c = std::max(0, column - kNearCells);
             c <= std::min(columns_ - 1, column + kNearCells);
             ++c)
            found |= owners_[static_cast<std::size_t>(r * columns_ + c)];
    return found;
}

/// Gives pixels of one cell from their owner to a rival. A reading beyond the gate counts as the
/// gate, so that what belongs to neither decides nothing.
void ShapeBorders::contest(
    const DisparityImage& image,
    std::span<const SceneShape> shapes,
    int column,
    int row,
    std::size_t owner,
    std::size_t rival
) {
    constexpr int kSide = kCell + 2 * kAround;
    std::array<std::array<double, kSide>, kSide> gain{};  // by going to the rival
    std::array<std::array<bool, kSide>, kSide> fits{};    // the rival
    const auto square = [&](std::size_t i, std::uint32_t pixel) {
        const double off = off_in_sigmas(shapes[i].fit, image, camera_, scale_, pixel);
        return std::abs(off) < kPixelSigmas ? off * off : kPixelSigmas * kPixelSigmas;
    };
    const int left = column * kCell - kAround, top = row * kCell - kAround;
    for (int v = 0; v < kSide; ++v)
        for (int u = 0; u < kSide; ++u) {
            const int x = left + u, y = top + v;
            if (x < 0 || y < 0 || x >= camera_.width || y >= camera_.height) continue;
            const auto pixel = static_cast<std::uint32_t>(y * camera_.width + x);
            const auto now = owner_[pixel];
            if (now != static_cast<std::int32_t>(owner) && now != static_cast<std::int32_t>(rival))
                continue;
            const double to_rival = square(rival, pixel);
            const auto row_at = static_cast<std::size_t>(v), at = static_cast<std::size_t>(u);
            fits[row_at][at] = to_rival < kPixelSigmas * kPixelSigmas;
            gain[row_at][at] = square(owner, pixel) - to_rival;
        }
    for (int v = kAround; v < kAround + kCell; ++v)
        for (int u = kAround; u < kAround + kCell; ++u) {
            const int x = left + u, y = top + v;
            if (x >= camera_.width || y >= camera_.height) continue;
            const auto pixel = static_cast<std::size_t>(y * camera_.width + x);
            if (owner_[pixel] != static_cast<std::int32_t>(owner)) continue;
            if (!fits[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)]) continue;
            double sum = 0.0;
            for (int dv = -kAround; dv <= kAround; ++dv)
                for (int du = -kAround; du <= kAround; ++du)
                    sum += gain[static_cast<std::size_t>(v + dv)][static_cast<std::size_t>(u + du)];
            if (sum > 0.0) next_[pixel] = static_cast<std::int32_t>(rival);
        }
}

void ShapeBorders::share_out(const DisparityImage& image, std::span<SceneShape> all) {
    const std::span<SceneShape> shapes = all.first(std::min(all.size(), kMostShapes));
    enter(shapes);
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            const std::uint64_t own = owners_[static_cast<std::size_t>(row * columns_ + column)];
            if (own == 0) continue;
            const std::uint64_t near = owners_near(column, row);
            if ((near & (near - 1)) == 0) continue;
            for (std::size_t i = 0; i < shapes.size(); ++i)
                for (std::size_t j = 0; j < shapes.size(); ++j)
                    if (i != j && (own >> i & 1) != 0 && (near >> j & 1) != 0)
                        contest(image, shapes, column, row, i, j);
        }
    for (auto& shape : shapes)
        shape.pixels.clear();
    for (std::uint32_t pixel = 0; pixel < next_.size(); ++pixel)
        if (next_[pixel] >= 0)
            shapes[static_cast<std::size_t>(next_[pixel])].pixels.push_back(pixel);
    for (auto& shape : shapes)
        shape.fit.quality.points = static_cast<int>(shape.pixels.size());
}

}  // namespace kinectlab
