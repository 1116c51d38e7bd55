#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

#include "pipeline/track/surface_patch.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_particle_filter.hpp"
#include "tests/bench/swing_frames.hpp"
#include "tests/unit/pipeline/support/mesh_room.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kFrames = 90;
const Eigen::Vector3d kSides(0.16, 0.10, 0.12);  // m

/// A hand moves it: a quarter of a metre a second, half a turn a minute at most, 1.2 m away.
Eigen::Isometry3d pose_at(double t) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(
        0.12 * std::sin(2.0 * t), 0.05 * std::cos(3.0 * t), 1.2 + 0.05 * std::sin(t)
    );
    T.linear() = (Eigen::AngleAxisd(0.6 + 0.4 * std::sin(t), Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(0.5 + 0.3 * std::sin(2.0 * t), Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
    return T;
}

/// The box's points in the first frame, in its own frame: PCL's tracker follows a segmented cloud.
std::vector<Eigen::Vector3f> points_seen(
    const RgbdCamera& camera, const RgbdFrame& frame, const Eigen::Isometry3d& T_cam_obj
) {
    const Eigen::Array3d reach = kSides.array() / 2.0 + 0.01;
    std::vector<Eigen::Vector3f> points;
    for (int v = 0; v < camera.depth.height; v += 2)
        for (int u = 0; u < camera.depth.width; u += 2) {
            const auto depth = frame.depth[static_cast<std::size_t>(v * camera.depth.width + u)];
            const Eigen::Vector3d p =
                T_cam_obj.inverse() * (camera.depth.ray(u, v) * (depth * camera.depth_unit_m));
            if ((p.array().abs() < reach).all()) points.emplace_back(p.cast<float>());
        }
    return points;
}

struct Score {
    double squares = 0.0, turns = 0.0, seconds = 0.0, worst = 0.0;
    int frames = 0;

    void add(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth, double took) {
        squares += (found.translation() - truth.translation()).squaredNorm();
        turns +=
            std::pow(Eigen::AngleAxisd(found.linear() * truth.linear().transpose()).angle(), 2);
        seconds += took;
        worst = std::max(worst, took);
        ++frames;
    }
    [[nodiscard]] double ms() const { return 1e3 * seconds / frames; }
    [[nodiscard]] double rms_mm() const { return 1e3 * std::sqrt(squares / frames); }
    [[nodiscard]] double rms_degrees() const { return 180 / M_PI * std::sqrt(turns / frames); }
};

}  // namespace

Figures measure_box_tracking() {
    test::MeshRoom room(1);
    const auto mesh = test::box_mesh(kSides.x(), kSides.y(), kSides.z());
    SurfacePatchSettings settings;
    settings.mesh = std::make_shared<const TriangleMesh>(mesh);
    const auto made = make_surface_patch_tracker(room.camera, {{0, "box", settings}});
    if (!made) throw std::runtime_error(to_text(made.error()));
    std::optional<ParticleFilter> filter;

    Score own, peer;
    std::vector<TrackSample> samples;
    for (int i = 0; i < kFrames; ++i) {
        const Eigen::Isometry3d truth = pose_at(i / 30.0);
        const auto frame = room.frame({{mesh, truth}});
        samples.clear();
        double start = thread_seconds();
        (*made)->track(frame, {}, samples);
        double took = thread_seconds() - start;
        if (samples[0].status != TrackStatus::tracked)
            throw std::runtime_error("the box was lost in frame " + std::to_string(i));
        Eigen::Isometry3d found = Eigen::Isometry3d::Identity();
        found.translation() = samples[0].p_cam;
        found.linear() = samples[0].q_cam_obj.toRotationMatrix();
        // The first frame is recognition's, of a box in any of its four equal poses.
        if (i > 0) {
            Eigen::Isometry3d nearest = found;
            for (const auto& axis :
                 {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
                Eigen::Isometry3d other = found;
                other.linear() = found.linear() * Eigen::AngleAxisd(M_PI, Eigen::Vector3d(axis));
                const auto off = [&](const Eigen::Isometry3d& T) {
                    return (T.linear() - truth.linear()).norm();
                };
                if (off(other) < off(nearest)) nearest = other;
            }
            own.add(nearest, truth, took);
        }
        if (!filter) filter.emplace(room.camera, points_seen(room.camera, frame, truth), truth);
        start = thread_seconds();
        const Eigen::Isometry3d theirs = filter->track(frame);
        took = thread_seconds() - start;
        if (i > 0) peer.add(theirs, truth, took);
    }
    const std::string name = "box of 16x10x12 cm at 1.2 m";
    const std::string peer_name = "PCL KLD particle filter";
    return {
        {name + ", time a frame",
         own.ms(),
         "ms",
         peer.ms() / 20.0,
         Better::lower,
         peer.ms(),
         peer_name},
        {name + ", slowest frame",
         1e3 * own.worst,
         "ms",
         33.0,
         Better::lower,
         1e3 * peer.worst,
         peer_name},
        {name + ", RMS of position",
         own.rms_mm(),
         "mm",
         peer.rms_mm() / 5.0,
         Better::lower,
         peer.rms_mm(),
         peer_name},
        {name + ", RMS of orientation",
         own.rms_degrees(),
         "°",
         peer.rms_degrees() / 5.0,
         Better::lower,
         peer.rms_degrees(),
         peer_name}};
}

}  // namespace kinectlab::bench
