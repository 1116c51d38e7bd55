#include <cmath>

#include <Eigen/LU>

#include "pipeline/track/shape_detect.hpp"
#include "pipeline/track/tracker.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_shapes.hpp"
#include "tests/bench/swing_frames.hpp"
#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kFrames = 60;
constexpr int kStockFrames = 8;

/// Offset along the normal at the true middle, and turn, against a board's front face.
struct Errors {
    double place2 = 0.0, turn2 = 0.0, ms = 0.0;
    int found = 0, frames = 0;

    void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, const test::Solid& truth) {
        place2 += std::pow(n.normalized().dot(p - truth.place), 2);
        turn2 += n.normalized().cross(truth.axis).squaredNorm();
        ++found;
    }
    [[nodiscard]] double place_m() const { return std::sqrt(place2 / std::max(1, found)); }
    [[nodiscard]] double turn_rad() const { return std::sqrt(turn2 / std::max(1, found)); }
    [[nodiscard]] double mean_ms() const { return ms / std::max(1, frames); }
    [[nodiscard]] double share() const { return static_cast<double>(found) / std::max(1, frames); }
};

/// The Cramér-Rao bound of a plane a·ray = 1/Z from independent errors of the disparity: it is
/// linear, so the information is Σ ray rayᵀ / σ².
struct PlaneBound {
    double place_m = 0.0, turn_rad = 0.0;
};
PlaneBound plane_bound(
    const test::ShapeRoom& room, const test::Solid& truth, std::span<const std::uint32_t> pixels
) {
    const auto& camera = room.camera.depth;
    const double sigma = room.camera.noise.inverse_depth_step * room.sigma_steps;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const auto pixel : pixels) {
        const Eigen::Vector3d ray = camera.ray(
            static_cast<double>(pixel % static_cast<std::uint32_t>(camera.width)),
            static_cast<double>(pixel / static_cast<std::uint32_t>(camera.width))
        );
        information += ray * ray.transpose() / (sigma * sigma);
    }
    const Eigen::Matrix3d covariance = information.inverse();
    const double d = truth.axis.dot(truth.place);
    const Eigen::Vector3d a = truth.axis / d;
    // The distance of the middle p along the normal is (a·p - 1)/|a|; the turn is that of a.
    const Eigen::Matrix3d across =
        (Eigen::Matrix3d::Identity() - truth.axis * truth.axis.transpose()) / a.norm();
    return {
        std::sqrt(truth.place.dot(covariance * truth.place)) / a.norm(),
        std::sqrt((across * covariance * across).trace())};
}

void add_figures(
    Figures& figures,
    const std::string& name,
    const Errors& ours,
    const Errors& stock,
    const std::string& peer
) {
    const auto add = [&](const std::string& what, double own, const char* unit, double other) {
        figures.push_back({name + what, own, unit, {}, Better::lower, other, peer});
    };
    add("", ours.mean_ms(), "ms", stock.mean_ms());
    figures.push_back(
        {name + ": found", ours.share(), "1", 1.0, Better::higher, stock.share(), peer}
    );
    add(": place along its normal, RMS", 1e3 * ours.place_m(), "mm", 1e3 * stock.place_m());
    add(": turn, RMS", 1e3 * ours.turn_rad(), "mrad", 1e3 * stock.turn_rad());
}

void measure_board(Figures& figures) {
    test::ShapeRoom room(12);
    // The front of a board of 30 x 20 cm, as a wall that ends: its box's face.
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.3, 1.0, 0.0).normalized()).toRotationMatrix();
    const Eigen::Vector3d middle(0.05, 0.02, 1.2);
    room.solids = {
        test::box(middle, turn, {0.15, 0.10, 0.005}), test::wall({0, 0, 2.5}, {0, 0, -1})};
    const Eigen::Vector3d normal = -turn.col(2);
    const test::Solid truth = test::wall(middle + 0.005 * normal, normal);
    SegmentShapes shapes(room.camera);
    DisparityImage image(room.camera);
    const ShapeTarget target{0, ShapeKind::plane};
    Errors ours, stock;
    std::vector<std::uint32_t> pixels, face;
    for (int i = 0; i <= kFrames; ++i) {
        const RgbdFrame frame = room.frame();
        if (pixels.empty()) {
            pixels = room.pixels_of(0);
            face = room.pixels_of(0, 4);
        }
        const double start = thread_seconds();
        image.load_around(frame.depth, pixels);
        const auto fit = shapes.in_segment(image, pixels, target);
        if (i == 0) continue;  // buffers grow once
        ours.ms += 1e3 * (thread_seconds() - start);
        ++ours.frames;
        if (fit) ours.add(fit->shape.point, fit->shape.axis, truth);
        if (i > kStockFrames) continue;
        const StockShape peer = stock_shape(room.camera, frame, pixels, ShapeKind::plane);
        stock.ms += peer.segmentation_ms;
        ++stock.frames;
        if (peer.shape) stock.add(peer.shape->point, peer.shape->axis, truth);
    }
    const std::string name = "plane, region of interest, normals included";
    add_figures(figures, name, ours, stock, "PCL RANSAC, normals given");
    const PlaneBound bound = plane_bound(room, truth, face);
    figures.push_back({name + ": place over Cramér-Rao", ours.place_m() / bound.place_m, "1", 1.3});
    figures.push_back({name + ": turn over Cramér-Rao", ours.turn_rad() / bound.turn_rad, "1", {}});
}

constexpr double kBallRadius = 0.035;
constexpr double kAroundM = 0.25;  // of the ball: what the peer is given to look at

/// A plank that falls to the right before a wall and above a floor, a ball rolling down on it.
void measure_under(Figures& figures) {
    test::ShapeRoom room(5);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.14, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d middle(0.0, 0.45, 1.6), normal = -turn.col(1);
    room.solids = {
        test::ball(Eigen::Vector3d::Zero(), kBallRadius),
        test::box(middle, turn, {0.6, 0.01, 0.15}),
        test::wall({0, 0, 3.2}, {0, 0, -1}),
        test::wall({0, 0.95, 0}, {0, -1, 0})};
    const test::Solid truth = test::wall(middle + 0.01 * normal, normal);
    const std::vector<ObjectSpec> objects{
        {"ball", SphereSettings{.radius_m = kBallRadius}},
        {"plank", PlaneSettings{.under = "ball"}}};
    const auto trackers = make_trackers(room.camera, objects).value();
    Errors ours, stock;
    double first_ms = 0.0;
    for (int i = 0; i < kFrames; ++i) {
        auto& ball = room.solids[0];
        ball.place = middle + turn.col(0) * (-0.45 + 0.015 * i) + normal * (0.01 + kBallRadius);
        room.changed();
        const RgbdFrame frame = room.frame();
        const auto pixels = room.pixels_of(0);
        const MovedPixels moved{pixels};
        std::vector<TrackSample> samples;
        double start = thread_seconds();
        trackers[0]->track(frame, std::span(&moved, 1), samples);
        start = thread_seconds();  // the ball has its own figures
        trackers[1]->track(frame, std::span(&moved, 1), samples);
        const double took = 1e3 * (thread_seconds() - start);
        if (i == 0) first_ms = took;
        if (i > 0) ours.ms += took, ++ours.frames;
        const auto& plank = samples.back();
        if (i > 0 && plank.status == TrackStatus::tracked)
            ours.add(plank.p_cam, plank.q_cam_obj * Eigen::Vector3d::UnitZ(), truth);
        if (i >= kStockFrames) continue;
        std::vector<std::uint32_t> around;
        const auto width = static_cast<std::uint32_t>(room.camera.depth.width);
        for (std::uint32_t pixel = 0; pixel < frame.depth.size(); ++pixel) {
            const Eigen::Vector3d p = room.camera.depth.ray(pixel % width, pixel / width) *
                                      (frame.depth[pixel] * room.camera.depth_unit_m);
            const double far = (p - ball.place).norm();
            if (far < kAroundM && far > 1.3 * kBallRadius) around.push_back(pixel);
        }
        const StockShape peer = stock_shape(room.camera, frame, around, ShapeKind::plane);
        stock.ms += peer.normals_ms + peer.segmentation_ms;
        ++stock.frames;
        if (peer.shape) stock.add(peer.shape->point, peer.shape->axis, truth);
    }
    const std::string name = "plane under a ball, followed";
    add_figures(figures, name, ours, stock, "PCL RANSAC on what is near the ball");
    figures.push_back({name + ": its first frame", first_ms, "ms", {}});
}

}  // namespace

Figures measure_planes() {
    Figures figures;
    measure_board(figures);
    measure_under(figures);
    return figures;
}

}  // namespace kinectlab::bench
