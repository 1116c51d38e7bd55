#include <chrono>
#include <cmath>

#include <Eigen/LU>

#include "pipeline/track/tracker.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_colour.hpp"
#include "tests/unit/pipeline/support/textured_scene.hpp"

namespace kinectlab::bench {
namespace {

using test::PrintedBox;
using test::TexturedScene;

constexpr int kFrames = 30;

double now_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch()
    )
        .count();
}

/// A green box that drifts and turns a little before a grey wall.
PrintedBox box_at(int step) {
    PrintedBox box;
    box.print = 0;
    box.half_m = {0.06, 0.10, 0.03};
    box.colour = {40.0, 170.0, 60.0};
    box.T_cam_box.translation() << -0.1 + 0.006 * step, 0.02, 1.1 + 0.003 * step;
    const Eigen::Vector3d axis = Eigen::Vector3d(0.2, 0.3, 1.0).normalized();
    box.T_cam_box.linear() = Eigen::AngleAxisd(0.1 + 0.01 * step, axis).toRotationMatrix();
    return box;
}

/// Centroid of the visible surface without any noise.
Eigen::Vector3d true_place(const PrintedBox& box) {
    TexturedScene exact(1);
    exact.sigma_steps = exact.edge_px = exact.colour_noise = 0.0;
    const RgbdFrame frame = exact.frame({box});
    const Pinhole& k = exact.camera.depth;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int points = 0;
    for (int v = 0; v < k.height; ++v)
        for (int u = 0; u < k.width; ++u) {
            const double z =
                exact.camera.depth_unit_m * frame.depth[static_cast<std::size_t>(v * k.width + u)];
            if (z > 0.9 * exact.wall_m) continue;
            sum += k.ray(u, v) * z;
            ++points;
        }
    return sum / points;
}

struct Accuracy {
    double squares_m = 0.0, normalised = 0.0, best_ms = 1e9;
    int found = 0;
    void add(const Eigen::Vector3d& off, double ms) {
        squares_m += off.squaredNorm();
        best_ms = std::min(best_ms, ms);
        ++found;
    }
    [[nodiscard]] double rms_mm() const { return 1e3 * std::sqrt(squares_m / std::max(1, found)); }
};

}  // namespace

Figures measure_colour_place() {
    TexturedScene scene(7);
    std::vector<RgbdFrame> frames;
    std::vector<Eigen::Vector3d> truth;
    for (int step = 0; step < kFrames; ++step) {
        // The light wanders as a camera's own adjustments let it.
        scene.gain = {1.0 - 0.01 * step, 1.0 - 0.012 * step, 1.0 - 0.008 * step};
        frames.push_back(scene.frame({box_at(step)}));
        truth.push_back(true_place(box_at(step)));
    }
    const Eigen::Vector2d at = scene.camera.colour.project(
        scene.camera.T_colour_depth * box_at(0).T_cam_box.translation()
    );
    const ColourSettings click{
        .box = PictureBox{static_cast<int>(at.x()), static_cast<int>(at.y()), 1, 1}};
    const std::vector<ObjectSpec> objects{{"box", click}};
    const auto trackers = make_trackers(scene.camera, objects).value();
    // Bounds that a person would set by hand about the box's green.
    const OpenCvColourPlace peer(scene.camera, {50, 80, 40}, {80, 255, 255});

    Accuracy own, stock;
    std::vector<TrackSample> samples;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        samples.clear();
        double start = now_ms();
        trackers.front()->track(frames[i], {}, samples);
        double ms = now_ms() - start;
        const TrackSample& sample = samples.front();
        if (i > 0 && sample.status == TrackStatus::tracked) {
            const Eigen::Vector3d off = sample.p_cam - truth[i];
            own.add(off, ms);
            const Eigen::Matrix3d covariance = sample.covariance.topLeftCorner<3, 3>();
            own.normalised += off.dot(covariance.inverse() * off);
        }
        start = now_ms();
        const auto place = peer.place(frames[i]);
        ms = now_ms() - start;
        if (i > 0 && place) stock.add(*place - truth[i], ms);
    }
    const std::string cv = "OpenCV inRange, biggest component";
    const double all = kFrames - 1;
    return {
        {"colour: one frame to place", own.best_ms, "ms", {}, Better::lower, stock.best_ms, cv},
        {"colour: frames found", own.found / all, "1", 1.0, Better::higher, stock.found / all, cv},
        {"colour: RMS place",
         own.rms_mm(),
         "mm",
         stock.rms_mm(),
         Better::lower,
         stock.rms_mm(),
         cv},
        {"colour: normalised error squared of 3-D place (3 is right)",
         own.normalised / std::max(1, own.found),
         "1",
         6.0,
         Better::lower,
         {},
         ""},
    };
}

}  // namespace kinectlab::bench
