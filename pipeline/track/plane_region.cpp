#include "pipeline/track/plane_region.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinectlab {
namespace {

constexpr double kNearSigmas = 6.0;         // as far out as the fit looks
constexpr std::size_t kFewestPixels = 200;  // of a whole plane
constexpr std::size_t kFewestOfPiece = 12;  // smaller ones are noise
constexpr int kMostRounds = 12;
constexpr double kGrown = 1.02;  // times as many pixels: else it has reached its edges
constexpr double kMaxRmsSigmas = 3.0;
constexpr double kMinInlierShare = 0.6;

}  // namespace

PlaneRegion::PlaneRegion(const RgbdCamera& camera)
    : camera_(camera), scale_(camera), fitter_(camera), pieces_(camera) {
    const auto pixels = static_cast<std::size_t>(camera.depth.width * camera.depth.height);
    region_.resize(pixels);
    near_.resize(pixels);
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
    std::uint8_t* near = near_.data();
    for (int v = 0; v < view.height; ++v, near += view.width) {
        const float* row = image.row(v);
        const auto first = static_cast<float>(m.dot(view.ray(0, v)));
        for (int u = 0; u < view.width; ++u) {
            const float off = row[u] - (first + per_column * static_cast<float>(u));
            near[u] = static_cast<std::uint8_t>((row[u] > 0.0F) & (std::abs(off) < gate));
        }
    }
}

/// Of the continuous pieces in near_ those that go on from what is known to be of the plane: the
/// ball may lie across it, and part it in two.
void PlaneRegion::keep_connected(const RgbdFrame& frame, const std::vector<std::uint8_t>& known) {
    kept_.clear();
    const auto in_all = static_cast<std::size_t>(std::count(known.begin(), known.end(), 1));
    for (const auto& piece : pieces_.cut(frame.depth, near_, kFewestOfPiece)) {
        const auto in_known = static_cast<std::size_t>(std::count_if(
            piece.begin(), piece.end(), [&](std::uint32_t i) { return known[i] != 0; }
        ));
        if (20 * in_known < in_all && 2 * in_known < piece.size()) continue;
        kept_.insert(kept_.end(), piece.begin(), piece.end());
    }
    std::sort(kept_.begin(), kept_.end());
}

std::optional<ShapeFit> PlaneRegion::fit(const DisparityImage& image, const Shape& guess) {
    auto found = fitter_.fit(image, kept_, guess, false);
    if (!found) return found;
    const double s = scale_.steps_at(std::max(0.1, found->shape.point.z()));
    if (found->quality.rms_steps > kMaxRmsSigmas * scale_.sigma_at(s) ||
        found->quality.inlier_share < kMinInlierShare)
        found.reset();
    return found;
}

std::optional<ShapeFit> PlaneRegion::grow(
    const RgbdFrame& frame,
    const DisparityImage& image,
    const Shape& rough,
    std::span<const std::uint32_t> pixels
) {
    std::fill(growing_.begin(), growing_.end(), std::uint8_t{0});
    kept_.assign(pixels.begin(), pixels.end());
    auto found = fit(image, rough);
    std::size_t size = kept_.size();
    for (int i = 0; found && i < kMostRounds; ++i) {
        for (const std::uint32_t pixel : kept_)
            growing_[pixel] = 1;
        find_near(image, found->shape);
        keep_connected(frame, growing_);
        found = fit(image, found->shape);
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

std::optional<ShapeFit> PlaneRegion::follow(const RgbdFrame& frame, const DisparityImage& image) {
    if (!plane_) return std::nullopt;
    find_near(image, *plane_);
    keep_connected(frame, region_);
    if (kept_.size() < kFewestPixels) return std::nullopt;
    const auto found = fit(image, *plane_);
    if (!found) return std::nullopt;
    plane_ = found->shape;
    std::fill(region_.begin(), region_.end(), std::uint8_t{0});
    for (const std::uint32_t pixel : kept_)
        region_[pixel] = 1;
    return found;
}

}  // namespace kinectlab
