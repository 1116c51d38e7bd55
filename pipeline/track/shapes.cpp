#include "pipeline/track/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/shape_borders.hpp"
#include "pipeline/track/shape_grid.hpp"
#include "pipeline/track/shape_pair.hpp"
#include "pipeline/track/shape_pool.hpp"
#include "pipeline/track/shape_search.hpp"
#include "pipeline/track/shape_whole.hpp"

namespace kinectlab {
namespace {

constexpr int kHalfWindow = 5;  // px, of the normals' windows
constexpr int kHalfSteepWindow = 3;
constexpr int kMostDraws = 20000;
constexpr int kMostGrowths = 4;
constexpr int kGrowCells = 2;  // normals near an edge are of both sides
constexpr std::size_t kSearchPoints = 256;
constexpr int kSearchTries = 96;
constexpr std::size_t kComparePixels = 4096;
constexpr double kPlainCost = 0.12;  // Tukey's loss of noise alone is 0.08 at a gate of 6σ
constexpr double kSimplerCost = 1.15;
constexpr double kMaxSizeShareU = 0.15;
constexpr double kMaxRmsSigmas = 3.0;
constexpr int kMostFailures = 40;
constexpr Tolerance kRough{3.0, 0.002, 0.05, 0.87};
constexpr Tolerance kFine{3.0, 0.002, 0.0, 0.87};

constexpr std::array kKinds{
    ShapeKind::plane, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone};

SizeLimits limits_of(const ShapesSettings& settings, ShapeKind kind) {
    if (kind == ShapeKind::cone) return {{}, 0.08, 1.2};
    return {{}, settings.min_radius_m, settings.max_radius_m};
}

double least_cells(const ShapesSettings& settings) {
    return std::max(8.0, 0.5 * settings.min_points / (ShapeGrid::kCell * ShapeGrid::kCell));
}

ShapePool::Rules rules_of(const ShapesSettings& settings) {
    ShapePool::Rules rules;
    rules.kinds = settings.kinds;
    for (const auto kind : kKinds)
        rules.limits[static_cast<std::size_t>(kind)] = limits_of(settings, kind);
    rules.least_points = least_cells(settings);
    rules.miss_probability = settings.miss_probability;
    rules.tolerance = kRough;
    return rules;
}

}  // namespace

struct ShapeDetector::State {
    State(const RgbdCamera& camera_, const ShapesSettings& settings_)
        : camera(camera_),
          settings(settings_),
          scale(camera_),
          image(camera_),
          fitter(camera_),
          pair(camera_),
          borders(camera_),
          grid(camera_.depth),
          pool(rules_of(settings_)),
          order(grid.shuffled_pixels()) {
        taken.resize(
            static_cast<std::size_t>(camera.depth.width) *
            static_cast<std::size_t>(camera.depth.height)
        );
        points.reserve(grid.cells());
        rest.reserve(grid.cells());
        own.reserve(kSearchPoints);
    }

    [[nodiscard]] double min_cells() const { return least_cells(settings); }

    [[nodiscard]] bool is_big(std::span<const std::uint32_t> component) const {
        return static_cast<double>(component.size()) >= min_cells();
    }

    /// Some of the component's pixels, on which fits are compared.
    void choose_compared() {
        grid.collect_pixels(image, taken, 0, pixels);
        compared.clear();
        const std::size_t stride = 1 + pixels.size() / kComparePixels;
        for (std::size_t i = 0; i < pixels.size(); i += stride)
            compared.push_back(pixels[i]);
    }

    /// A round candidate through few points is rough, and a part of a can may look like a bent
    /// face: refined on what it explains, it explains more. Its component is the grid's then.
    Shape grow(Shape shape) {
        std::size_t size = grid.find_component(shape, points, kRough).size();
        for (int i = 0; i < kMostGrowths && shape.kind != ShapeKind::plane; ++i) {
            choose_compared();
            const auto fit = sound_fit(shape);
            const auto before = std::exchange(shape, fit ? fit->shape : shape);
            const std::size_t grown = grid.find_component(shape, points, kRough).size();
            if (grown < size) shape = before;
            if (grown <= size) break;
            size = grown;
        }
        (void)grid.find_component(shape, points, kRough);
        return shape;
    }

    /// The simplest kind that explains the component's pixels nearly as well as any other, among
    /// those that stand there as a whole. A bulge that a ball fits but that is none may yet be a
    /// flat face; a richer kind it is only if that explains it better than the ball does.
    std::optional<ShapeFit> best_kind(const Shape& shape) {
        choose_compared();
        grid.collect_points(points, kSearchPoints, own);
        std::array<std::optional<ShapeFit>, kKinds.size()> fits;
        double least = 1.0, least_simpler = 1.0;
        for (const auto kind : kKinds) {
            auto& best = fits[static_cast<std::size_t>(kind)];
            best = best_of_kind(kind, shape);
            if (!best) continue;
            if (kind == ShapeKind::plane && best->cost < kPlainCost) return best;
            const double simpler =
                std::exchange(least_simpler, std::min(least_simpler, best->cost));
            if (best->cost < simpler && is_whole(*best, image, camera.depth, scale) &&
                !is_edge(*best))
                least = std::min(least, best->cost);
            else
                best.reset();
        }
        for (const auto& fit : fits)
            if (fit && fit->cost <= kSimplerCost * least + 0.01) return fit;
        return std::nullopt;
    }

    /// Whether two faces explain the compared pixels better than a round shape does.
    [[nodiscard]] bool is_edge(const ShapeFit& fit) {
        return fit.shape.kind != ShapeKind::plane && settings.kinds[0] &&
               pair.cost(image, compared, own) + 0.01 < fit.cost;
    }

    /// What explains the compared pixels best, whole or not.
    std::optional<ShapeFit> best_of_kind(ShapeKind kind, const Shape& shape) {
        if (!settings.kinds[static_cast<std::size_t>(kind)]) return std::nullopt;
        auto best = kind == shape.kind ? sound_fit(shape) : std::nullopt;
        search_shape(kind, own, limits_of(settings, kind), kRough, {kSearchTries, 2}, guesses);
        for (const auto& guess : guesses) {
            auto fit = sound_fit(guess.shape);
            if (fit && (!best || fit->cost < best->cost)) best = std::move(fit);
        }
        return best;
    }

    std::optional<ShapeFit> sound_fit(const Shape& guess) {
        auto fit = fitter.fit(image, compared, guess, false);
        if (fit && !is_sound(*fit)) fit.reset();
        return fit;
    }

    [[nodiscard]] bool is_sound(const ShapeFit& fit) const {
        if (fit.shape.kind == ShapeKind::plane) return true;
        const SizeLimits limits = limits_of(settings, fit.shape.kind);
        return fit.shape.size >= limits.least && fit.shape.size <= limits.most &&
               fit.size_u <= kMaxSizeShareU * fit.shape.size;
    }

    /// Whether a candidate became a shape of the result.
    bool extract(const Shape& candidate) {
        if (!is_big(grid.find_component(candidate, points, kRough))) return false;
        auto fit = best_kind(grow(candidate));
        if (!fit) return false;
        if (!is_big(grid.find_component(fit->shape, points, kFine))) return false;
        grid.collect_pixels(image, taken, kGrowCells, pixels);
        const Shape guess = fit->shape;
        fit = fitter.fit(image, pixels, guess, false, FitStart::refined);
        if (!fit || !is_sound(*fit) || !is_whole(*fit, image, camera.depth, scale)) return false;

        if (result.size() <= results) result.emplace_back();
        SceneShape& found = result[results];
        found.pixels.clear();
        double squares = 0.0;
        for (const auto pixel : pixels) {
            const double off = off_in_sigmas(*fit, image, camera.depth, scale, pixel);
            if (!(std::abs(off) <= kPixelSigmas)) continue;
            squares += off * off;
            found.pixels.push_back(pixel);
        }
        const auto size = static_cast<double>(found.pixels.size());
        if (size < settings.min_points || squares > kMaxRmsSigmas * kMaxRmsSigmas * size)
            return false;
        fit->quality.points = static_cast<int>(found.pixels.size());
        found.fit = *fit;
        for (const auto pixel : found.pixels)
            taken[pixel] = 1;
        ++results;
        return true;
    }

    /// Takes the points away whose pixels belong to shapes now.
    void drop_taken() {
        rest.clear();
        for (std::size_t i = 0; i < points.size; ++i)
            if (taken[points.pixel[i]] == 0) rest.copy(points, i);
        rest.pad();
        std::swap(points, rest);
        grid.index(points);
        pool.look_again(points);
    }

    /// In random order. A face seen so steeply that it falls too far within a window has points
    /// of a smaller one.
    void find_points() {
        find_surface_points(image, camera, order, kHalfWindow, rest);
        grid.index(rest);
        steep.clear();
        for (const auto pixel : order)
            if (grid.point_in(grid.cell_of(pixel)) < 0) steep.push_back(pixel);
        find_surface_points(image, camera, steep, kHalfSteepWindow, own);
        points.clear();
        std::size_t i = 0, j = 0;
        for (const auto pixel : order) {
            if (i < rest.size && rest.pixel[i] == pixel) points.copy(rest, i++);
            if (j < own.size && own.pixel[j] == pixel) points.copy(own, j++);
        }
        points.pad();
        grid.index(points);
    }

    void detect(std::span<const std::uint16_t> depth) {
        results = 0;
        const auto size = static_cast<std::size_t>(camera.depth.width) *
                          static_cast<std::size_t>(camera.depth.height);
        if (depth.size() != size) return;
        image.load(depth);
        find_points();
        std::fill(taken.begin(), taken.end(), std::uint8_t{0});
        pool.begin();
        int failures = 0;
        while (static_cast<int>(results) < settings.max_shapes && failures < kMostFailures &&
               static_cast<double>(points.size) >= min_cells() && pool.draws() < kMostDraws) {
            pool.draw(points, grid);
            if (pool.is_empty()) {
                if (!pool.may_have_missed(min_cells(), points.size)) break;
                continue;
            }
            const std::size_t best = pool.sure_best(points);
            if (pool.may_have_missed(pool.support_of(best), points.size)) continue;
            const Shape candidate = pool.take(best);
            if (!extract(candidate)) {
                ++failures;
                continue;
            }
            drop_taken();
            failures = 0;
        }
        borders.share_out(image, {result.data(), results});
        std::sort(
            result.begin(),
            result.begin() + static_cast<std::ptrdiff_t>(results),
            [](const SceneShape& a, const SceneShape& b) {
                return a.pixels.size() > b.pixels.size();
            }
        );
        while (results > 0 &&
               result[results - 1].pixels.size() < static_cast<std::size_t>(settings.min_points))
            --results;  // its neighbours have its pixels now
    }

    RgbdCamera camera;
    ShapesSettings settings;
    DisparityScale scale;
    DisparityImage image;
    ShapeFitter fitter;
    PlanePair pair;
    ShapeBorders borders;
    ShapeGrid grid;
    ShapePool pool;
    std::vector<std::uint32_t> order;  // the grid's pixels, at random
    SurfacePoints points, rest, own;   // points not taken yet, in that order
    std::vector<ShapeCandidate> guesses;
    std::vector<std::uint8_t> taken;  // pixels
    std::vector<std::uint32_t> pixels, compared, steep;
    std::vector<SceneShape> result;
    std::size_t results = 0;
};

ShapeDetector::ShapeDetector(std::unique_ptr<State> state) : state_(std::move(state)) {}
ShapeDetector::ShapeDetector(ShapeDetector&&) noexcept = default;
ShapeDetector& ShapeDetector::operator=(ShapeDetector&&) noexcept = default;
ShapeDetector::~ShapeDetector() = default;

Result<ShapeDetector> ShapeDetector::create(
    const RgbdCamera& camera, const ShapesSettings& settings
) {
    const auto refuse = [](const char* field, double value, const char* cure) {
        return fail(ErrorCode::invalid_argument, field, "is " + number_text(value), cure);
    };
    if (std::none_of(settings.kinds.begin(), settings.kinds.end(), [](bool kind) { return kind; }))
        return refuse("kinds", 0, "ask for at least one kind of shape");
    if (!(settings.min_radius_m > 0.0))
        return refuse("min_radius_m", settings.min_radius_m, "give metres above 0");
    if (!(settings.max_radius_m > settings.min_radius_m) || !(settings.max_radius_m <= 2.0))
        return refuse(
            "max_radius_m", settings.max_radius_m, "give metres above min_radius_m, 2 at most"
        );
    if (settings.min_points < 50)
        return refuse("min_points", settings.min_points, "give 50 pixels or more");
    if (settings.max_shapes < 1) return refuse("max_shapes", settings.max_shapes, "give 1 or more");
    if (!(settings.miss_probability > 0.0 && settings.miss_probability < 1.0))
        return refuse("miss_probability", settings.miss_probability, "give a number in (0, 1)");
    return ShapeDetector(std::make_unique<State>(camera, settings));
}

std::span<const SceneShape> ShapeDetector::detect(std::span<const std::uint16_t> depth) {
    state_->detect(depth);
    return {state_->result.data(), state_->results};
}

}  // namespace kinectlab
