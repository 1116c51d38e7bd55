#include "pipeline/track/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/track/shape_borders.hpp"
#include "pipeline/track/shape_search.hpp"
#include "pipeline/track/shape_support.hpp"

namespace kinectlab {
namespace {

constexpr int kCell = 4;        // px: one oriented point for each cell of the grid
constexpr int kHalfWindow = 5;  // px, of the normals' windows
constexpr int kDraws = 64;      // samples between two looks at the best
constexpr int kMostDraws = 20000;
constexpr std::size_t kFirstSubset = 256;
constexpr std::size_t kPool = 48;            // candidates that are kept from draw to draw
constexpr std::array kReaches{2, 4, 8, 16};  // cells: neighbourhoods that samples are drawn from
constexpr double kSampleOdds = 1.0 / 16.0;   // that a sample from a shape's point is all its own
constexpr int kGrowCells = 2;                // normals near an edge are of both sides
constexpr std::size_t kSearchPoints = 256;
constexpr int kSearchTries = 96;
constexpr std::size_t kComparePixels = 4096;
constexpr double kPlainCost = 0.12;  // Tukey's loss of noise alone is 0.08 at a gate of 6σ
constexpr double kSimplerCost = 1.15;
constexpr double kMaxSizeShareU = 0.15;
constexpr double kMaxRmsSigmas = 3.0;
constexpr int kMostFailures = 40;

constexpr std::array kKinds{
    ShapeKind::plane, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone};

/// A candidate and what is known of its support.
struct Pooled {
    Shape shape;
    std::size_t seen = 0;  // points of the random order that were looked at
    int found = 0;
    SupportBounds bounds;
};

}  // namespace

struct ShapeDetector::State {
    State(const RgbdCamera& camera_, const ShapesSettings& settings_)
        : camera(camera_),
          settings(settings_),
          scale(camera_),
          image(camera_),
          fitter(camera_),
          borders(camera_),
          columns((camera_.depth.width + kCell - 1) / kCell),
          rows((camera_.depth.height + kCell - 1) / kCell) {
        const auto cells = static_cast<std::size_t>(columns * rows);
        const auto pixels = static_cast<std::size_t>(camera.depth.width) *
                            static_cast<std::size_t>(camera.depth.height);
        point_of.resize(cells);
        mark.resize(cells);
        stack.reserve(cells);
        component.reserve(cells);
        largest.reserve(cells);
        taken.resize(pixels);
        holds.resize(cells + SurfacePoints::kLanes);
        points.reserve(cells);
        rest.reserve(cells);
        own.reserve(kSearchPoints);
        shuffle_cells();
    }

    /// The grid's pixels in a random order that is the same in every run.
    void shuffle_cells() {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                const int u = std::min(kCell * column + kCell / 2, camera.depth.width - 1);
                const int v = std::min(kCell * row + kCell / 2, camera.depth.height - 1);
                order.push_back(static_cast<std::uint32_t>(v * camera.depth.width + u));
            }
        ShapeRandom shuffle;
        for (std::size_t i = order.size(); i > 1; --i)
            std::swap(order[i - 1], order[shuffle.below(i)]);
    }

    [[nodiscard]] std::size_t cell_of(std::uint32_t pixel) const {
        const auto width = static_cast<std::uint32_t>(camera.depth.width);
        return pixel / width / kCell * static_cast<std::size_t>(columns) + pixel % width / kCell;
    }

    void index_points() {
        std::fill(point_of.begin(), point_of.end(), -1);
        for (std::size_t i = 0; i < points.size; ++i)
            point_of[cell_of(points.pixel[i])] = static_cast<std::int32_t>(i);
    }

    [[nodiscard]] SizeLimits limits_of(ShapeKind kind) const {
        if (kind == ShapeKind::cone) return {{}, 0.08, 1.2};
        return {{}, settings.min_radius_m, settings.max_radius_m};
    }

    // --- candidates ---------------------------------------------------------------------------

    /// A point and up to two neighbours of it, all from one part of the picture.
    bool draw(std::array<OrientedPoint, 4>& sample) {
        const std::size_t seed = random.below(points.size);
        const std::size_t cell = cell_of(points.pixel[seed]);
        const int column = static_cast<int>(cell) % columns, row = static_cast<int>(cell) / columns;
        const int reach = kReaches[random.below(kReaches.size())];
        const auto span = static_cast<std::size_t>(2 * reach + 1);
        sample[0] = points.at(seed);
        for (std::size_t k = 1; k < sample.size(); ++k) {
            std::int32_t other = -1;
            for (int attempt = 0; attempt < 4 && other < 0; ++attempt) {
                const int c = column + static_cast<int>(random.below(span)) - reach;
                const int r = row + static_cast<int>(random.below(span)) - reach;
                if (c < 0 || r < 0 || c >= columns || r >= rows || (c == column && r == row))
                    continue;
                other = point_of[static_cast<std::size_t>(r * columns + c)];
            }
            if (other < 0) return false;
            sample[k] = points.at(static_cast<std::size_t>(other));
        }
        return true;
    }

    [[nodiscard]] static bool agrees(const Shape& shape, const OrientedPoint& point) {
        const Eigen::Vector3d out = outwards(shape, point.p_cam);
        const double norm = out.norm();
        if (!(out.dot(point.normal) >= 0.9 * norm)) return false;
        const double off =
            shape.kind == ShapeKind::plane
                ? height_on(shape, point.p_cam)
                : (out.dot(point.p_cam - shape.point) - quadric_of(shape).rho) / (2.0 * norm);
        return std::abs(off) <= 0.015 * point.p_cam.z();
    }

    void draw_candidates() {
        std::array<OrientedPoint, 4> sample;
        for (int i = 0; i < kDraws; ++i) {
            if (!draw(sample)) continue;
            for (const auto kind : kKinds) {
                if (!settings.kinds[static_cast<std::size_t>(kind)]) continue;
                const auto shape = propose(kind, sample, limits_of(kind));
                if (!shape || !agrees(*shape, sample[2]) || !agrees(*shape, sample[3])) continue;
                Pooled one{*shape};
                look(one, kFirstSubset);
                if (one.bounds.high >= min_cells()) enter_pool(one);
            }
        }
        draws += kDraws;
    }

    void look(Pooled& one, std::size_t until) const {
        const std::size_t end = std::min(until, points.size);
        one.found += count_support(one.shape, points, one.seen, end, rough());
        one.seen = end;
        one.bounds = extrapolate(one.found, end, points.size);
    }

    void enter_pool(const Pooled& one) {
        if (pool.size() < kPool) {
            pool.push_back(one);
            return;
        }
        const auto worst =
            std::min_element(pool.begin(), pool.end(), [](const Pooled& a, const Pooled& b) {
                return a.bounds.middle < b.bounds.middle;
            });
        if (worst->bounds.middle < one.bounds.middle) *worst = one;
    }

    /// Looks at more points of the leading candidates until none can be better than the best.
    std::size_t sure_best() {
        while (true) {
            std::size_t best = 0;
            for (std::size_t i = 1; i < pool.size(); ++i)
                if (pool[i].bounds.middle > pool[best].bounds.middle) best = i;
            bool sure = true;
            const auto further = [&](Pooled& one) {
                if (one.seen >= points.size) return;
                look(one, 2 * one.seen);
                sure = false;
            };
            for (std::size_t i = 0; i < pool.size(); ++i)
                if (i != best && pool[i].bounds.high > pool[best].bounds.low) further(pool[i]);
            if (!sure || pool.size() == 1) further(pool[best]);
            if (sure) return best;
        }
    }

    [[nodiscard]] bool may_have_missed(double support) const {
        const double found = std::min(
            0.999,
            kSampleOdds * support / static_cast<double>(std::max<std::size_t>(1, points.size))
        );
        return std::log(settings.miss_probability) < draws * std::log(1.0 - found);
    }

    [[nodiscard]] double min_cells() const {
        return std::max(8.0, 0.5 * settings.min_points / (kCell * kCell));
    }

    static Tolerance rough() { return {3.0, 0.002, 0.05, 0.87}; }
    static Tolerance fine() { return {3.0, 0.002, 0.0, 0.87}; }

    // --- extraction ---------------------------------------------------------------------------

    /// The largest connected part of a shape's support, as cells of the grid.
    void find_component(const Shape& shape, const Tolerance& tolerance) {
        mark_support(shape, points, tolerance, holds);
        std::fill(mark.begin(), mark.end(), std::uint8_t{0});
        for (std::size_t i = 0; i < points.size; ++i)
            if (holds[i] != 0) mark[cell_of(points.pixel[i])] = 1;
        largest.clear();
        for (std::size_t start = 0; start < mark.size(); ++start) {
            if (mark[start] != 1) continue;
            component.clear();
            stack.assign(1, static_cast<std::uint32_t>(start));
            mark[start] = 2;
            while (!stack.empty()) {
                const auto cell = static_cast<int>(stack.back());
                stack.pop_back();
                component.push_back(static_cast<std::uint32_t>(cell));
                const int column = cell % columns, row = cell / columns;
                for (int r = std::max(0, row - 1); r <= std::min(rows - 1, row + 1); ++r)
                    for (int c = std::max(0, column - 1); c <= std::min(columns - 1, column + 1);
                         ++c) {
                        const auto next = static_cast<std::size_t>(r * columns + c);
                        if (mark[next] != 1) continue;
                        mark[next] = 2;
                        stack.push_back(static_cast<std::uint32_t>(next));
                    }
            }
            if (component.size() > largest.size()) largest.swap(component);
        }
    }

    /// Free pixels with a reading in the component's cells and those within `grow` cells of it, in
    /// reading order.
    void collect_pixels(int grow) {
        std::fill(mark.begin(), mark.end(), std::uint8_t{0});
        for (const auto cell : largest) {
            const int column = static_cast<int>(cell) % columns,
                      row = static_cast<int>(cell) / columns;
            for (int r = std::max(0, row - grow); r <= std::min(rows - 1, row + grow); ++r)
                for (int c = std::max(0, column - grow); c <= std::min(columns - 1, column + grow);
                     ++c)
                    mark[static_cast<std::size_t>(r * columns + c)] = 1;
        }
        pixels.clear();
        for (int v = 0; v < camera.depth.height; ++v) {
            const float* row = image.row(v);
            const auto* marks = mark.data() + static_cast<std::ptrdiff_t>(v / kCell) * columns;
            for (int column = 0; column < columns; ++column) {
                if (marks[column] == 0) continue;
                const int end = std::min(kCell * (column + 1), camera.depth.width);
                for (int u = kCell * column; u < end; ++u) {
                    const auto pixel = static_cast<std::uint32_t>(v * camera.depth.width + u);
                    if (row[u] > 0.0F && taken[pixel] == 0) pixels.push_back(pixel);
                }
            }
        }
    }

    /// The component's points, so many that its kind can be told.
    void own_points() {
        std::fill(mark.begin(), mark.end(), std::uint8_t{0});
        for (const auto cell : largest)
            mark[cell] = 1;
        own.clear();
        for (std::size_t i = 0; i < points.size && own.size < kSearchPoints; ++i)
            if (mark[cell_of(points.pixel[i])] != 0) own.copy(points, i);
        own.pad();
    }

    /// The simplest kind that explains the component's pixels nearly as well as any other.
    std::optional<ShapeFit> best_kind(const Shape& shape) {
        collect_pixels(0);
        compared.clear();
        const std::size_t stride = 1 + pixels.size() / kComparePixels;
        for (std::size_t i = 0; i < pixels.size(); i += stride)
            compared.push_back(pixels[i]);
        own_points();
        std::array<std::optional<ShapeFit>, kKinds.size()> fits;
        double least = 1.0;
        for (const auto kind : kKinds) {
            const auto k = static_cast<std::size_t>(kind);
            if (!settings.kinds[k]) continue;
            if (kind == shape.kind) fits[k] = sound_fit(shape);
            search_shape(kind, own, limits_of(kind), rough(), {kSearchTries, 2}, guesses);
            for (const auto& guess : guesses) {
                auto fit = sound_fit(guess.shape);
                if (fit && (!fits[k] || fit->cost < fits[k]->cost)) fits[k] = std::move(fit);
            }
            if (!fits[k]) continue;
            if (kind == ShapeKind::plane && fits[k]->cost < kPlainCost) return fits[k];
            least = std::min(least, fits[k]->cost);
        }
        for (const auto& fit : fits)
            if (fit && fit->cost <= kSimplerCost * least + 0.01) return fit;
        return std::nullopt;
    }

    std::optional<ShapeFit> sound_fit(const Shape& guess) {
        auto fit = fitter.fit(image, compared, guess, false);
        if (fit && !is_sound(*fit)) fit.reset();
        return fit;
    }

    [[nodiscard]] bool is_sound(const ShapeFit& fit) const {
        if (fit.shape.kind == ShapeKind::plane) return true;
        const SizeLimits limits = limits_of(fit.shape.kind);
        return fit.shape.size >= limits.least && fit.shape.size <= limits.most &&
               fit.size_u <= kMaxSizeShareU * fit.shape.size;
    }

    /// Whether a candidate became a shape of the result.
    bool extract(const Shape& candidate) {
        find_component(candidate, rough());
        if (static_cast<double>(largest.size()) < min_cells()) return false;
        auto fit = best_kind(candidate);
        if (!fit) return false;
        find_component(fit->shape, fine());
        if (static_cast<double>(largest.size()) < min_cells()) return false;
        collect_pixels(kGrowCells);
        const Shape guess = fit->shape;
        fit = fitter.fit(image, pixels, guess, false);
        if (!fit || !is_sound(*fit)) return false;

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
        index_points();
        auto kept = pool.begin();
        for (auto& one : pool) {
            one.seen = 0;
            one.found = 0;
            look(one, kFirstSubset);
            if (one.bounds.high >= min_cells()) *kept++ = one;
        }
        pool.erase(kept, pool.end());
    }

    void detect(std::span<const std::uint16_t> depth) {
        results = 0;
        const auto size = static_cast<std::size_t>(camera.depth.width) *
                          static_cast<std::size_t>(camera.depth.height);
        if (depth.size() != size) return;
        image.load(depth);
        find_surface_points(image, camera, order, kHalfWindow, points);
        index_points();
        std::fill(taken.begin(), taken.end(), std::uint8_t{0});
        pool.clear();
        random = ShapeRandom{};
        draws = 0.0;
        int failures = 0;
        while (static_cast<int>(results) < settings.max_shapes && failures < kMostFailures &&
               static_cast<double>(points.size) >= min_cells() && draws < kMostDraws) {
            draw_candidates();
            if (pool.empty()) {
                if (!may_have_missed(min_cells())) break;
                continue;
            }
            const std::size_t best = sure_best();
            if (may_have_missed(pool[best].bounds.middle)) continue;
            const Shape candidate = pool[best].shape;
            pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(best));
            if (extract(candidate))
                drop_taken();
            else
                ++failures;
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
    ShapeBorders borders;
    int columns, rows;
    ShapeRandom random;
    double draws = 0.0;
    std::vector<std::uint32_t> order;    // the grid's pixels, at random
    SurfacePoints points, rest, own;     // points not taken yet, in that order
    std::vector<std::int32_t> point_of;  // of each cell, -1 for none
    std::vector<Pooled> pool;
    std::vector<ShapeCandidate> guesses;
    std::vector<std::uint8_t> holds, mark, taken;
    std::vector<std::uint32_t> stack, component, largest;  // cells
    std::vector<std::uint32_t> pixels, compared;
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
        return fail(ErrorCode::invalid_argument, field, "is " + std::to_string(value), cure);
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
