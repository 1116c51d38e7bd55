#include <array>
#include <cmath>

#include "pipeline/track/shapes.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_scene.hpp"
#include "tests/bench/swing_frames.hpp"
#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kFrames = 6;

struct Truth {
    int solid;
    ShapeKind kind;
};

constexpr std::array kTruths{
    Truth{0, ShapeKind::plane},
    Truth{1, ShapeKind::plane},
    Truth{2, ShapeKind::sphere},
    Truth{3, ShapeKind::cylinder},
    Truth{4, ShapeKind::cone}};

/// A table before a wall; a ball, a can and a cone on it.
test::ShapeRoom table() {
    test::ShapeRoom room(31);
    const Eigen::Vector3d up = Eigen::Vector3d(0.0, -0.8, -0.6).normalized();
    const Eigen::Vector3d foot(0.0, 0.2, 1.2);
    const Eigen::Vector3d back = up.cross(Eigen::Vector3d::UnitX());
    const auto on_table = [&](double x, double y) {
        return Eigen::Vector3d(foot + x * Eigen::Vector3d::UnitX() + y * back);
    };
    room.solids = {
        test::wall(foot, up),
        test::wall({0, 0, 2.2}, {0.1, 0.05, -1}),
        test::ball(on_table(-0.28, 0.05) + 0.08 * up, 0.08),
        test::can(on_table(0.0, 0.0), up, 0.05, 0.2),
        test::cone(on_table(0.3, 0.05) + 0.24 * up, -up, 0.36, 0.02, 0.24)};
    return room;
}

/// Sums over frames of what a detector made of the true shapes.
struct Score {
    std::array<double, kTruths.size()> place2{}, axis2{}, size2{};
    std::array<int, kTruths.size()> found{};
    double right = 0.0, all = 0.0;  // pixels of the true shapes, and those given to the right one
    double ms = 0.0;
    int frames = 0;
};

void add_error(Score& score, std::size_t k, const Shape& shape, const test::Solid& truth) {
    Eigen::Vector3d off = shape.point - truth.place;
    if (kTruths[k].kind == ShapeKind::plane)  // where the camera's axis meets it
        off = Eigen::Vector3d::UnitZ() * (1.0 / meet(Eigen::Vector3d::UnitZ(), shape) -
                                          truth.axis.dot(truth.place) / truth.axis.z());
    if (kTruths[k].kind == ShapeKind::cylinder) {
        const Eigen::Vector3d middle = truth.place + 0.5 * truth.to * truth.axis;
        off = shape.point - middle;
        off -= shape.axis * (off.dot(truth.axis) / shape.axis.dot(truth.axis));
    }
    score.place2[k] += off.squaredNorm();
    if (kTruths[k].kind != ShapeKind::sphere)
        score.axis2[k] += shape.axis.cross(truth.axis).squaredNorm();
    if (kTruths[k].kind != ShapeKind::plane) {
        const double size = kTruths[k].kind == ShapeKind::cone ? truth.angle : truth.radius;
        score.size2[k] += std::pow(shape.size - size, 2);
    }
    ++score.found[k];
}

/// Each true shape is found by the one of its kind that has most of its pixels, if these are half.
void judge(const auto& shapes, const test::ShapeRoom& room, const auto& shape_of, Score& score) {
    for (std::size_t k = 0; k < kTruths.size(); ++k) {
        const int solid = kTruths[k].solid;
        const auto all = static_cast<double>(room.pixels_of(solid, 0).size());
        double most = 0.0;
        const Shape* best = nullptr;
        for (const auto& one : shapes) {
            if (shape_of(one).kind != kTruths[k].kind) continue;
            double own = 0.0;
            for (const auto pixel : one.pixels)
                own += room.solid_at[pixel] == solid && room.face_at[pixel] == 0 ? 1.0 : 0.0;
            if (own > most) most = own, best = &shape_of(one);
        }
        score.all += all;
        if (most < 0.5 * all) continue;
        score.right += most;
        add_error(score, k, *best, room.solids[static_cast<std::size_t>(solid)]);
    }
    ++score.frames;
}

/// Geometric mean over all parameters of how many times smaller our RMS error is.
double times_more_accurate(const Score& ours, const Score& stock) {
    double logs = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < kTruths.size(); ++k) {
        if (ours.found[k] == 0 || stock.found[k] == 0) continue;
        for (const auto member : {&Score::place2, &Score::axis2, &Score::size2}) {
            const double own = (ours.*member)[k] / ours.found[k];
            const double other = (stock.*member)[k] / stock.found[k];
            if (own == 0.0 || other == 0.0) continue;
            logs += 0.5 * std::log(other / own);
            ++count;
        }
    }
    return count > 0 ? std::exp(logs / count) : 0.0;
}

}  // namespace

Figures measure_shape_scene() {
    test::ShapeRoom room = table();
    auto detector = ShapeDetector::create(room.camera).value();
    DisparityImage image(room.camera);
    std::vector<std::uint32_t> everywhere;
    SurfacePoints points;
    Score ours, stock;
    bool has_peer = true;
    for (int i = 0; i < kFrames; ++i) {
        const RgbdFrame frame = room.frame();
        double start = thread_seconds();
        auto shapes = detector.detect(frame.depth);
        double ms = 1e3 * (thread_seconds() - start);
        start = thread_seconds();
        shapes = detector.detect(frame.depth);
        ms = std::min(ms, 1e3 * (thread_seconds() - start));
        ours.ms += ms;
        judge(
            shapes, room, [](const SceneShape& one) -> const Shape& { return one.fit.shape; }, ours
        );

        everywhere.resize(frame.depth.size());
        for (std::uint32_t pixel = 0; pixel < everywhere.size(); ++pixel)
            everywhere[pixel] = pixel;
        image.load(frame.depth);
        find_surface_points(image, room.camera, everywhere, 5, points);
        const auto peer = stock_scene(points);
        has_peer = peer.has_value();
        if (!has_peer) continue;
        stock.ms += peer->ms;
        judge(
            peer->shapes,
            room,
            [](const StockScene::Found& one) -> const Shape& { return one.shape; },
            stock
        );
    }
    const std::string name = "whole scene, four kinds of shape";
    const std::string peer_name = has_peer ? "CGAL" : "";
    const auto of_peer = [&](double value) {
        return has_peer ? std::optional(value) : std::nullopt;
    };
    const double recall = ours.right / ours.all,
                 peer_recall = stock.right / std::max(1.0, stock.all);
    Figures figures{
        {name + ", normals included (the peer's are given)",
         ours.ms / kFrames,
         "ms",
         of_peer(stock.ms / kFrames / 5.0),
         Better::lower,
         of_peer(stock.ms / kFrames),
         peer_name},
        {name + ": recall of points",
         recall,
         "1",
         of_peer(peer_recall),
         Better::higher,
         of_peer(peer_recall),
         peer_name}};
    if (has_peer)
        figures.push_back(
            {name + ": parameters, times more accurate",
             times_more_accurate(ours, stock),
             "1",
             5.0,
             Better::higher,
             {},
             {}}
        );
    for (std::size_t k = 0; k < kTruths.size(); ++k)
        figures.push_back(
            {name + ": " + std::string(name_of(kTruths[k].kind)) + " " +
                 std::to_string(kTruths[k].solid) + ", RMS of its place",
             1e3 * std::sqrt(ours.place2[k] / std::max(1, ours.found[k])),
             "mm",
             {},
             Better::lower,
             of_peer(1e3 * std::sqrt(stock.place2[k] / std::max(1, stock.found[k]))),
             peer_name + " found " + std::to_string(stock.found[k]) + " and we " +
                 std::to_string(ours.found[k]) + " of " + std::to_string(kFrames)}
        );
    return figures;
}

}  // namespace kinectlab::bench
