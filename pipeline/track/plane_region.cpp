#include "pipeline/track/plane_region.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/marks.hpp"

namespace kinectlab {
namespace {

constexpr double kNearSigmas = 4.0;  // wider would take in more of a face that begins at its edge
constexpr std::size_t kFewestPixels = 200;
constexpr int kMostRounds = 12;
constexpr double kGrown = 1.02;  // times as many pixels: else it has reached its edges
constexpr double kMaxRmsSigmas = 3.0;
constexpr double kMinInlierShare = 0.9;  // less where a fit slid from one face to the next
constexpr double kMostTurnU = 0.02;      // rad; planes through a strip of pixels may be turned more

// Within 4σ the first rows of a face that begins at the edge pass for the plane and turn it.
constexpr std::uint32_t kEdge = 2;   // px
constexpr double kMostOfEdge = 0.4;  // of all pixels: a plane seen so flatly keeps them

constexpr std::uint8_t kNear = 1, kKept = 2;  // in near_

struct Row {
    const float* disparity;
    std::uint8_t* near;
    int size;
};

/// Marks what is nearer than the gate to a plane's disparity, which changes by so much a column.
KINECTLAB_HOT_LOOP void mark_near(Row row, float first, float per_column, float gate) {
    const float* __restrict disparity = row.disparity;
    std::uint8_t* __restrict near = row.near;
    for (int u = 0; u < row.size; ++u) {
        const float off = disparity[u] - (first + per_column * static_cast<float>(u));
        const float there = disparity[u] > 0.0F ? 1.0F : 0.0F;
        const float is_near = std::abs(off) < gate ? there : 0.0F;
        near[u] = static_cast<std::uint8_t>(static_cast<int>(is_near));
    }
}

}  // namespace

PlaneRegion::PlaneRegion(const RgbdCamera& camera)
    : camera_(camera),
      scale_(camera),
      fitter_(camera),
      width_(static_cast<std::uint32_t>(camera.depth.width)),
      height_(static_cast<std::uint32_t>(camera.depth.height)) {
    const auto pixels = static_cast<std::size_t>(width_) * height_;
    region_.resize(pixels);
    near_.resize(std::size_t{near_at(height_ + 1)});
    growing_.resize(pixels);
}

/// The disparity of a plane is linear over the picture.
void PlaneRegion::find_near(const DisparityImage& image, const Shape& plane) {
    const Pinhole& view = camera_.depth;
    const Eigen::Vector3d m =
        plane.axis / (plane.axis.dot(plane.point) * scale_.inverse_depth_step);
    const auto per_column = static_cast<float>(m.x() / view.fx);
    // The noise grows with the rounding of near readings only, so one bound does for a picture.
    const double s_here = scale_.steps_at(std::max(0.1, plane.point.z()));
    const auto gate = static_cast<float>(kNearSigmas * scale_.sigma_at(s_here));
    for (std::uint32_t v = 0; v < height_; ++v) {
        const Row row{image.row(static_cast<int>(v)), near_.data() + near_at(v), view.width};
        const auto first = static_cast<float>(m.dot(view.ray(0, static_cast<int>(v))));
        mark_near(row, first, per_column, gate);
    }
}

/// All in near_ that goes on from what is known to be of the plane: the ball may lie across it and
/// part it in two. Lying in one plane they need no other proof of going on, and a plane seen so
/// steeply that it leaps from row to row would not pass it.
void PlaneRegion::keep_connected(const std::vector<std::uint8_t>& known) {
    kept_.clear();
    const auto visit = [&](std::uint32_t at) {
        if (near_[at] != kNear) return;
        near_[at] = kKept;
        kept_.push_back(at);
    };
    for (std::uint32_t v = 0; v < height_; ++v)
        for_each_marked(std::span(known).subspan(std::size_t{v} * width_, width_), [&](auto u) {
            visit(near_at(v) + static_cast<std::uint32_t>(u));
        });
    const std::uint32_t stride = near_at(1) - near_at(0);
    for (std::size_t next = 0; next < kept_.size(); ++next) {
        const std::uint32_t at = kept_[next];
        visit(at - 1);
        visit(at + 1);
        visit(at - stride);
        visit(at + stride);
    }
    kept_.clear();  // from here on pixels of the picture, in reading order
    for (std::uint32_t v = 0; v < height_; ++v) {
        const auto row = std::span(near_).subspan(near_at(v), width_);
        for_each_marked(row, [&](auto u) {
            if (row[u] == kKept) kept_.push_back(v * width_ + static_cast<std::uint32_t>(u));
        });
    }
}

/// Those of kept_ that do not lie at the region's edge.
void PlaneRegion::find_inner() {
    const std::uint32_t stride = near_at(1) - near_at(0);
    inner_.clear();
    for (const std::uint32_t pixel : kept_) {
        const std::uint32_t v = pixel / width_, u = pixel % width_;
        if (v < kEdge || v + kEdge >= height_ || u < kEdge || u + kEdge >= width_) continue;
        const std::uint8_t* at = near_.data() + near_at(v) + u;
        const std::uint32_t down = kEdge * stride;
        if (at[-static_cast<std::ptrdiff_t>(down)] == kKept && at[down] == kKept &&
            at[-static_cast<std::ptrdiff_t>(kEdge)] == kKept && at[kEdge] == kKept)
            inner_.push_back(pixel);
    }
    const auto all = static_cast<double>(kept_.size());
    if (static_cast<double>(inner_.size()) < (1.0 - kMostOfEdge) * all) inner_ = kept_;
}

std::optional<ShapeFit> PlaneRegion::fit(
    const DisparityImage& image, const Shape& guess, std::span<const std::uint32_t> pixels
) {
    auto found = fitter_.fit(image, pixels, guess, false);
    if (!found) return found;
    const double s = scale_.steps_at(std::max(0.1, found->shape.point.z()));
    const double turn = found->covariance.bottomRightCorner<3, 3>().trace() - kAnyAngle;
    if (found->quality.rms_steps > kMaxRmsSigmas * scale_.sigma_at(s) ||
        found->quality.inlier_share < kMinInlierShare || !(turn < kMostTurnU * kMostTurnU))
        found.reset();
    return found;
}

std::optional<ShapeFit> PlaneRegion::grow(
    const DisparityImage& image, const Shape& rough, std::span<const std::uint32_t> pixels
) {
    std::fill(growing_.begin(), growing_.end(), std::uint8_t{0});
    kept_.assign(pixels.begin(), pixels.end());
    auto found = fit(image, rough, kept_);
    std::size_t size = kept_.size();
    for (int i = 0; found && i < kMostRounds; ++i) {
        for (const std::uint32_t pixel : kept_)
            growing_[pixel] = 1;
        find_near(image, found->shape);
        keep_connected(growing_);
        find_inner();
        found = fit(image, found->shape, inner_);
        const auto before = static_cast<double>(std::exchange(size, kept_.size()));
        std::fill(growing_.begin(), growing_.end(), std::uint8_t{0});
        if (static_cast<double>(size) < kGrown * before) break;
    }
    if (!found || kept_.size() < kFewestPixels) return std::nullopt;
    plane_ = found->shape;
    std::swap(region_, growing_);
    for (const std::uint32_t pixel : kept_)
        region_[pixel] = 1;
    return found;
}

std::optional<ShapeFit> PlaneRegion::follow(const DisparityImage& image) {
    if (!plane_) return std::nullopt;
    find_near(image, *plane_);
    keep_connected(region_);
    if (kept_.size() < kFewestPixels) return std::nullopt;
    find_inner();
    const auto found = fit(image, *plane_, inner_);
    if (!found) return std::nullopt;
    plane_ = found->shape;
    std::fill(region_.begin(), region_.end(), std::uint8_t{0});
    for (const std::uint32_t pixel : kept_)
        region_[pixel] = 1;
    return found;
}

}  // namespace kinectlab
