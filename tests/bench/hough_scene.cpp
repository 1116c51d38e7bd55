#include <cmath>

#include "pipeline/track/shape_detect.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_shapes.hpp"
#include "tests/bench/swing_frames.hpp"
#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kFrames = 12;
constexpr int kStockFrames = 4;
constexpr int kStockStep = 3;        // pixels between the points that the peer gets
constexpr double kRightM = 0.02;     // of a ball's centre, or of a plane where it is asked
constexpr double kRightTurn = 0.05;  // rad

constexpr int kTable = 0, kBall = 2;

/// A table that fills most of the picture before a wall, and a ball on it.
test::ShapeRoom table_with_ball() {
    test::ShapeRoom room(41);
    const Eigen::Vector3d up = Eigen::Vector3d(0.0, -0.8, -0.6).normalized();
    const Eigen::Vector3d foot(0.0, 0.1, 1.2);
    room.solids = {
        test::wall(foot, up),
        test::wall({0, 0, 2.4}, {0.1, 0.05, -1}),
        test::ball(foot + Eigen::Vector3d(0.1, 0.0, 0.0) + 0.08 * up, 0.08)};
    return room;
}

struct Way {
    const char* name;
    ShapeKind kind;
    GuessBy search;
    std::optional<double> radius;
};

double error_of(const Shape& shape, const test::Solid& truth) {
    if (shape.kind == ShapeKind::sphere) return (shape.point - truth.place).norm();
    return std::abs(truth.axis.dot(shape.point - truth.place));
}

struct Tally {
    double squares = 0.0, ms = 0.0;
    int found = 0, frames = 0;

    void add(const std::optional<Shape>& shape, const test::Solid& truth, double took_ms) {
        ++frames;
        ms += took_ms;
        if (!shape) return;
        const double off = error_of(*shape, truth);
        const bool turned =
            shape->kind == ShapeKind::plane && shape->axis.cross(truth.axis).norm() > kRightTurn;
        if (off > kRightM || turned) return;
        squares += off * off;
        ++found;
    }
    [[nodiscard]] double rms_mm() const { return 1e3 * std::sqrt(squares / std::max(1, found)); }
};

void measure(const Way& way, Figures& figures) {
    test::ShapeRoom room = table_with_ball();
    SegmentShapes shapes(room.camera);
    DisparityImage image(room.camera);
    const SphereSettings defaults;
    ShapeTarget target{0, way.kind, {way.radius, defaults.min_radius_m, defaults.max_radius_m}};
    target.in = LookIn::scene;
    target.search = way.search;
    const auto& truth = room.solids[way.kind == ShapeKind::plane ? kTable : kBall];
    Tally ours, stock;
    std::vector<std::uint32_t> grid;
    for (int v = 0; v < room.camera.depth.height; v += kStockStep)
        for (int u = 0; u < room.camera.depth.width; u += kStockStep)
            grid.push_back(static_cast<std::uint32_t>(v * room.camera.depth.width + u));
    for (int i = 0; i <= kFrames; ++i) {
        const RgbdFrame frame = room.frame();
        const double start = thread_seconds();
        image.load(frame.depth);
        const auto fit = shapes.in_scene(image, target);
        const double took = 1e3 * (thread_seconds() - start);
        if (i == 0) continue;  // buffers grow once
        ours.add(fit ? std::optional(fit->shape) : std::nullopt, truth, took);
        if (i > kStockFrames) continue;
        const StockShape peer = stock_shape(room.camera, frame, grid, way.kind);
        stock.add(peer.shape, truth, peer.normals_ms + peer.segmentation_ms);
    }
    const std::string name = std::string("Hough transform in a scene, ") + way.name;
    const std::string peer = "PCL RANSAC, every 9th point";
    figures.push_back(
        {name, ours.ms / ours.frames, "ms", {}, Better::lower, stock.ms / stock.frames, peer}
    );
    figures.push_back(
        {name + ": found",
         static_cast<double>(ours.found) / ours.frames,
         "1",
         1.0,
         Better::higher,
         static_cast<double>(stock.found) / stock.frames,
         peer}
    );
    figures.push_back(
        {name + ": place, RMS where found",
         ours.rms_mm(),
         "mm",
         {},
         Better::lower,
         stock.found > 0 ? std::optional(stock.rms_mm()) : std::nullopt,
         peer}
    );
}

}  // namespace

Figures measure_hough() {
    Figures figures;
    measure({"plane", ShapeKind::plane, GuessBy::hough, {}}, figures);
    measure({"sphere of known radius", ShapeKind::sphere, GuessBy::hough, 0.08}, figures);
    measure({"sphere of any radius", ShapeKind::sphere, GuessBy::hough, {}}, figures);
    return figures;
}

}  // namespace kinectlab::bench
