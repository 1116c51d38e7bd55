#include "pipeline/track/shape_detect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/track/hough.hpp"
#include "pipeline/track/shape_borders.hpp"
#include "pipeline/track/shape_whole.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kPoints = 160;  // oriented points of a segment
constexpr SearchEffort kGuesses{256, 3};
constexpr SearchEffort kSecondGuesses{512, 8, 128, 88172645U};  // where none of the first settles
constexpr SearchEffort kSceneGuesses{256, 6};
constexpr SearchEffort kRivals{32, 2};
constexpr std::size_t kComparePixels = 512;
constexpr double kSimplerCost = 1.15;     // what a simpler kind may be worse and still explain it
constexpr double kHopeless = 2.0;         // times that: another guess will not do either
constexpr double kMinInlierShare = 0.35;  // of the segment: lids, strings and hands belong to it
constexpr double kPlentyOfInliers = 0.7;  // no further guess is tried
constexpr double kMaxRmsSigmas = 3.0;
constexpr double kMaxSizeShareU = 0.15;  // a size less sure than this is no measurement
constexpr int kFewestPoints = 60;
constexpr int kSceneStride = 6;        // px between the points that vote in a scene
constexpr double kNearSigmas = 16.0;   // of a scene's pixels: nearer would cut the noise itself
constexpr double kBallAndRim = 1.2;    // radii: a ball's own pixels, those of its rim too
constexpr int kVotings = 2;            // the second without what was found but not wanted
constexpr double kPlainCost = 0.14;    // of noise alone 0.08; a lid that begins there adds to it
constexpr std::size_t kFewPixels = 4;  // every 4th tells whether to look closer
constexpr double kWholeRays = 250.0;   // of a segment: its time counts
constexpr double kMayBeHeld = 1.0;     // of a segment: a hand may lie before any part of it

constexpr Tolerance kRough{3.0, 0.002, 0.08, 0.82};

/// Half the window of the normals' fit: a fifth of the radius if all pixels were one disc.
int half_window_for(std::size_t pixels) {
    const double radius_px = std::sqrt(static_cast<double>(pixels) / std::numbers::pi);
    return static_cast<int>(std::clamp(radius_px / 5.0, 2.0, 5.0));
}

}  // namespace

SegmentShapes::SegmentShapes(const RgbdCamera& camera)
    : camera_(camera), scale_(camera), fitter_(camera), rival_(camera), pair_(camera) {}

/// Evenly over the reading order, and so over the surface.
void SegmentShapes::sample(const DisparityImage& image, std::span<const std::uint32_t> pixels) {
    places_.clear();
    const std::size_t count = std::min(kPoints, pixels.size());
    for (std::size_t k = 0; k < count; ++k)
        places_.push_back(pixels[(2 * k + 1) * pixels.size() / (2 * count)]);
    find_surface_points(image, camera_, places_, half_window_for(pixels.size()), points_);
}

void SegmentShapes::guess(const ShapeTarget& target, const SearchEffort& effort) {
    const bool votes = target.search == GuessBy::hough;
    if (votes && target.kind == ShapeKind::plane)
        hough_planes(points_, kRough, effort.most_found, guesses_);
    else if (votes && target.kind == ShapeKind::sphere)
        hough_spheres(points_, target.limits, kRough, effort.most_found, guesses_);
    else
        search_shape(target.kind, points_, target.limits, kRough, effort, guesses_);
}

bool SegmentShapes::is_sound(const ShapeFit& fit, const ShapeTarget& target) const {
    const double s = scale_.steps_at(std::max(0.1, fit.shape.point.z()));
    if (fit.quality.points < kFewestPoints ||
        fit.quality.rms_steps > kMaxRmsSigmas * scale_.sigma_at(s))
        return false;
    if (fit.shape.kind == ShapeKind::plane || target.limits.known) return true;
    return fit.shape.size >= target.limits.least && fit.shape.size <= target.limits.most &&
           fit.size_u <= kMaxSizeShareU * fit.shape.size;
}

double SegmentShapes::best_cost(const DisparityImage& image, ShapeKind kind, double hopeless) {
    SizeLimits limits;
    if (kind == ShapeKind::cone) limits = {{}, kLeastConeAngle, kMostConeAngle};
    search_shape(kind, points_, limits, kRough, kRivals, guesses_);
    return rival_.least_misfit(image, compared_, guesses_, hopeless);
}

bool SegmentShapes::is_its_kind(const DisparityImage& image, const ShapeFit& fit) {
    for (const auto kind :
         {ShapeKind::plane, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone}) {
        if (kind == fit.shape.kind) continue;
        const bool simpler = kind < fit.shape.kind;
        // Guesses of simpler kinds lead to the same place; those of richer ones may lead astray.
        const double as_good = kSimplerCost * fit.cost + 0.01;
        const double cost = best_cost(image, kind, simpler ? kHopeless * as_good : 1.0);
        if (simpler && cost <= as_good) return false;
        if (!simpler && fit.cost > kSimplerCost * cost + 0.01) return false;
    }
    return true;
}

/// The guess that explains the compared pixels best, refined on them.
std::optional<ShapeFit> SegmentShapes::best_guess(
    const DisparityImage& image, const ShapeTarget& target
) {
    std::optional<ShapeFit> best;
    for (const auto& guess : guesses_) {
        auto fit = rival_.fit(image, compared_, guess.shape, target.limits.known.has_value());
        if (!fit || !is_sound(*fit, target) || fit->quality.inlier_share < kMinInlierShare)
            continue;
        if (!best || fit->cost < best->cost) best = std::move(fit);
        if (best->quality.inlier_share > kPlentyOfInliers) break;
    }
    return best;
}

std::optional<ShapeFit> SegmentShapes::in_segment(
    const DisparityImage& image, std::span<const std::uint32_t> pixels, const ShapeTarget& target
) {
    sample(image, pixels);
    // Guesses and rivals are tried on some of the pixels only.
    compared_.clear();
    const std::size_t stride = 1 + pixels.size() / kComparePixels;
    for (std::size_t i = 0; i < pixels.size(); i += stride)
        compared_.push_back(pixels[i]);
    guess(target, kGuesses);
    auto found = best_guess(image, target);
    if (!found && !guesses_.empty() && target.search == GuessBy::ransac) {
        guess(target, kSecondGuesses);
        found = best_guess(image, target);
    }
    if (!found || !is_its_kind(image, *found) || is_faces(image, *found)) return std::nullopt;
    const bool known = target.limits.known.has_value();
    found = fitter_.fit(image, pixels, found->shape, known, FitStart::refined);
    if (found && (!is_sound(*found, target) ||
                  !is_whole(*found, image, camera_.depth, scale_, kWholeRays, kMayBeHeld)))
        found.reset();
    return found;
}

/// Mean of Tukey's loss over those of every n-th compared pixel that lie on a shape.
double SegmentShapes::cost_on(const DisparityImage& image, const ShapeFit& fit, std::size_t n) {
    near_.clear();
    double loss = 0.0;
    for (std::size_t i = 0; i < compared_.size(); i += n) {
        const double off = off_in_sigmas(fit, image, camera_.depth, scale_, compared_[i]);
        const double t = off / kLastGateSigmas;
        if (!(std::abs(t) < 1.0)) continue;
        near_.push_back(compared_[i]);
        loss += 1.0 - std::pow(1.0 - t * t, 3);
    }
    return loss / static_cast<double>(std::max<std::size_t>(1, near_.size()));
}

/// Whether the faces of a box explain what lies on a round shape better than the shape does. What
/// else is in the segment, as a lid or a hand, says nothing.
bool SegmentShapes::is_faces(const DisparityImage& image, const ShapeFit& fit) {
    if (fit.shape.kind == ShapeKind::plane) return false;
    if (cost_on(image, fit, kFewPixels) <= kPlainCost) return false;
    const double cost = cost_on(image, fit, 1);
    own_.clear();
    for (std::size_t i = 0; i < points_.size; ++i)
        if (std::abs(off_in_sigmas(fit, image, camera_.depth, scale_, points_.pixel[i])) <
            kLastGateSigmas)
            own_.copy(points_, i);
    own_.pad();
    for (const int faces : {2, 3})
        if (kSimplerCost * pair_.cost(image, near_, own_, faces) + 0.01 < cost) return true;
    return false;
}

bool SegmentShapes::lies_on(const DisparityImage& image, const Shape& shape, std::uint32_t pixel)
    const {
    const auto width = static_cast<std::uint32_t>(camera_.depth.width);
    const double s = image.at(pixel);
    const Eigen::Vector3d ray = camera_.depth.ray(pixel % width, pixel / width);
    if (shape.kind == ShapeKind::sphere)
        return (scale_.metres(s) * ray - shape.point).norm() < kBallAndRim * shape.size;
    const double off = s - meet(ray, shape) / camera_.noise.inverse_depth_step;
    return std::abs(off) < kNearSigmas * scale_.sigma_at(s);
}

void SegmentShapes::near_pixels(const DisparityImage& image, const Shape& shape) {
    near_.clear();
    const auto width = static_cast<std::uint32_t>(camera_.depth.width);
    const auto pixels = width * static_cast<std::uint32_t>(camera_.depth.height);
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        const double s = image.at(pixel);
        if (s <= 0.0) continue;
        const double w = meet(camera_.depth.ray(pixel % width, pixel / width), shape);
        const double off = s - w / camera_.noise.inverse_depth_step;
        if (!(std::abs(off) < kNearSigmas * scale_.sigma_at(s))) continue;  // or NaN
        if (!is_passed_by(image, pixel)) near_.push_back(pixel);
    }
}

/// Far away the noise is as large as a small ball, which then fits on any wall.
bool SegmentShapes::is_flat(const DisparityImage& image, const ShapeFit& ball) {
    const Eigen::Vector3d towards = -ball.shape.point.normalized();
    const Eigen::Vector3d front = ball.shape.point + ball.shape.size * towards;
    const ShapeCandidate face{{ShapeKind::plane, front, towards, 0.0}, 0};
    return rival_.least_misfit(image, near_, {&face, 1}, 1.0) <= kSimplerCost * ball.cost + 0.01;
}

std::optional<ShapeFit> SegmentShapes::in_scene(
    const DisparityImage& image,
    const ShapeTarget& target,
    std::span<const Shape> taken,
    const Worth& worth
) {
    if (target.kind != ShapeKind::plane && target.kind != ShapeKind::sphere) return std::nullopt;
    passed_by_.assign(taken.begin(), taken.end());
    std::optional<ShapeFit> best;
    double most = 0.0;
    for (int voting = 0; voting < kVotings && !best; ++voting) {
        const std::size_t before = passed_by_.size();
        vote(image, target);
        unwanted_.clear();
        for (const auto& guess : guesses_) {
            near_pixels(image, guess.shape);
            auto fit = fitter_.fit(image, near_, guess.shape, target.limits.known.has_value());
            if (!fit || !is_sound(*fit, target) || !is_whole(*fit, image, camera_.depth, scale_))
                continue;
            if (target.kind == ShapeKind::sphere && is_flat(image, *fit)) continue;
            const double wanted = worth(*fit);
            if (wanted <= 0.0) unwanted_.push_back(fit->shape);
            if (wanted <= most) continue;
            most = wanted;
            best = std::move(fit);
        }
        passed_by_.insert(passed_by_.end(), unwanted_.begin(), unwanted_.end());
        if (passed_by_.size() == before) break;
    }
    return best;
}

void SegmentShapes::vote(const DisparityImage& image, const ShapeTarget& target) {
    places_.clear();
    const int width = camera_.depth.width;
    for (int v = kSceneStride / 2; v < camera_.depth.height; v += kSceneStride)
        for (int u = kSceneStride / 2; u < width; u += kSceneStride) {
            const auto pixel = static_cast<std::uint32_t>(v * width + u);
            if (!is_passed_by(image, pixel)) places_.push_back(pixel);
        }
    find_surface_points(image, camera_, places_, 4, points_);
    guess(target, kSceneGuesses);
}

bool SegmentShapes::is_passed_by(const DisparityImage& image, std::uint32_t pixel) const {
    return std::any_of(passed_by_.begin(), passed_by_.end(), [&](const Shape& shape) {
        return lies_on(image, shape, pixel);
    });
}

std::optional<ShapeFit> SegmentShapes::with_known_size(
    const DisparityImage& image, const SceneShape& found, double size
) {
    Shape guess = found.fit.shape;
    guess.size = size;
    return fitter_.fit(image, found.pixels, guess, true);
}

}  // namespace kinectlab
