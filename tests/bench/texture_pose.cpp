#include <chrono>
#include <cmath>
#include <stdexcept>

#include "pipeline/features/sift.hpp"
#include "pipeline/track/tracker.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_sift_pose.hpp"
#include "tests/unit/pipeline/support/textured_scene.hpp"

namespace kinectlab::bench {
namespace {

using test::PrintedBox;
using test::TexturedScene;

constexpr int kFrames = 20;

double now_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch()
    )
        .count();
}

PrintedBox box_at(int step) {
    PrintedBox box;
    box.half_m = {0.08, 0.11, 0.04};
    box.T_cam_box.translation() << 0.008 * step, 0.02, 1.2 + 0.008 * step;
    const Eigen::Vector3d axis = Eigen::Vector3d(0.1, 1.0, 0.2).normalized();
    box.T_cam_box.linear() = Eigen::AngleAxisd(0.1 + 0.015 * step, axis).toRotationMatrix();
    return box;
}

struct Recording {
    RgbdCamera camera;
    std::vector<RgbdFrame> frames;
    std::vector<PrintedBox> boxes;
    PictureBox first_look;
};

Recording record() {
    TexturedScene scene(11);
    Recording recording;
    recording.camera = scene.camera;
    for (int step = 0; step < kFrames; ++step) {
        recording.boxes.push_back(box_at(step));
        recording.frames.push_back(scene.frame({recording.boxes.back()}));
    }
    const Eigen::Vector2d at = scene.camera.colour.project(
        scene.camera.T_colour_depth * box_at(0).T_cam_box.translation()
    );
    recording.first_look = {static_cast<int>(at.x()) - 30, static_cast<int>(at.y()) - 42, 60, 84};
    return recording;
}

Eigen::Isometry3d true_motion(const Recording& recording, std::size_t i) {
    return recording.boxes[i].T_cam_box * recording.boxes[0].T_cam_box.inverse();
}

/// RMS over the frames after the first of where the box's middle is put and how it is turned.
struct Accuracy {
    double squares_m = 0.0, squares_rad = 0.0;
    int found = 0;
    double best_ms = 1e9;
    void add(const Eigen::Vector3d& off_m, const Eigen::Matrix3d& off_turn, double ms) {
        squares_m += off_m.squaredNorm();
        squares_rad += std::pow(Eigen::AngleAxisd(off_turn).angle(), 2);
        ++found;
        best_ms = std::min(best_ms, ms);
    }
    [[nodiscard]] double rms_mm() const { return 1e3 * std::sqrt(squares_m / std::max(1, found)); }
    [[nodiscard]] double rms_deg() const {
        return 57.29578 * std::sqrt(squares_rad / std::max(1, found));
    }
};

Accuracy own(const Recording& recording, TextureSpots spots) {
    const TextureSettings settings{.box = recording.first_look, .spots = spots};
    const std::vector<ObjectSpec> objects{{"box", settings}};
    const auto trackers = make_trackers(recording.camera, objects).value();
    Accuracy accuracy;
    std::vector<TrackSample> samples;
    TrackSample first;
    for (std::size_t i = 0; i < recording.frames.size(); ++i) {
        samples.clear();
        const double start = now_ms();
        trackers.front()->track(recording.frames[i], {}, samples);
        const double ms = now_ms() - start;
        if (i == 0) first = samples.front();
        if (i == 0 || samples.front().status != TrackStatus::tracked) continue;
        const Eigen::Isometry3d truth = true_motion(recording, i);
        accuracy.add(
            samples.front().p_cam - truth * first.p_cam,
            samples.front().q_cam_obj.matrix() * truth.linear().transpose(),
            ms
        );
    }
    return accuracy;
}

Accuracy stock(const Recording& recording) {
    const PictureBox& box = recording.first_look;
    OpenCvSiftPose peer(
        recording.camera, recording.frames[0], box.left, box.top, box.width, box.height
    );
    Accuracy accuracy;
    const Eigen::Vector3d middle = recording.boxes[0].T_cam_box.translation() -
                                   Eigen::Vector3d(0.0, 0.0, recording.boxes[0].half_m.z());
    for (std::size_t i = 1; i < recording.frames.size(); ++i) {
        const double start = now_ms();
        const auto motion = peer.motion(recording.frames[i]);
        const double ms = now_ms() - start;
        if (!motion) continue;
        const Eigen::Isometry3d truth = true_motion(recording, i);
        accuracy.add(
            *motion * middle - truth * middle, motion->linear() * truth.linear().transpose(), ms
        );
    }
    return accuracy;
}

/// Share of the first frame's spots on the box's front that are found again in later frames, within
/// 1.5 px of where the box's motion takes them.
double repeatability(
    const Recording& recording, const std::vector<std::vector<Keypoint2d>>& spots
) {
    int asked = 0, found = 0;
    const RgbdCamera& camera = recording.camera;
    const Eigen::Isometry3d T_depth_colour = camera.T_colour_depth.inverse();
    const PrintedBox& box = recording.boxes[0];
    for (const auto& spot : spots[0]) {
        // Where the colour ray meets the front, the face z = -half of the box.
        const Eigen::Isometry3d T_box_cam = box.T_cam_box.inverse();
        const Eigen::Vector3d o = T_box_cam * T_depth_colour.translation();
        const Eigen::Vector3d d =
            T_box_cam.linear() * T_depth_colour.linear() * camera.colour.ray(spot.u, spot.v);
        const Eigen::Vector3d p = o + d * ((-box.half_m.z() - o.z()) / d.z());
        if (std::abs(p.x()) > 0.9 * box.half_m.x() || std::abs(p.y()) > 0.9 * box.half_m.y())
            continue;
        for (std::size_t i = 1; i < recording.frames.size(); ++i) {
            const Eigen::Vector2d at =
                camera.colour.project(camera.T_colour_depth * (recording.boxes[i].T_cam_box * p));
            ++asked;
            for (const auto& other : spots[i]) {
                const double ratio = other.scale_px / spot.scale_px;
                if (std::hypot(other.u - at.x(), other.v - at.y()) > 1.5 || ratio > 1.5 ||
                    ratio < 0.66)
                    continue;
                ++found;
                break;
            }
        }
    }
    return asked > 0 ? static_cast<double>(found) / asked : 0.0;
}

}  // namespace

Figures measure_texture_pose() {
    const Recording recording = record();
    const Accuracy sift = own(recording, TextureSpots::sift);
    const Accuracy binary = own(recording, TextureSpots::binary);
    const Accuracy peer = stock(recording);
    const double frames = kFrames - 1;

    Sift whole;
    std::vector<std::vector<Keypoint2d>> own_spots, peer_spots;
    double own_ms = 1e9, peer_ms = 1e9;
    for (const auto& frame : recording.frames) {
        double start = now_ms();
        const Pinhole& k = recording.camera.colour;
        whole.find(frame.rgb, k.width, {0, 0, k.width, k.height});
        own_ms = std::min(own_ms, now_ms() - start);
        own_spots.emplace_back(whole.keypoints().begin(), whole.keypoints().end());
        start = now_ms();
        peer_spots.push_back(opencv_sift(recording.camera, frame));
        peer_ms = std::min(peer_ms, now_ms() - start);
    }
    const std::string cv = "OpenCV SIFT + PnP";
    return {
        {"2-D texture pose, SIFT around the last place",
         sift.best_ms,
         "ms",
         peer.best_ms / 3,
         Better::lower,
         peer.best_ms,
         cv},
        {"2-D texture pose, SIFT: frames found",
         sift.found / frames,
         "1",
         {},
         Better::higher,
         peer.found / frames,
         cv},
        {"2-D texture pose, SIFT: RMS place",
         sift.rms_mm(),
         "mm",
         peer.rms_mm(),
         Better::lower,
         peer.rms_mm(),
         cv},
        {"2-D texture pose, SIFT: RMS turn",
         sift.rms_deg(),
         "deg",
         peer.rms_deg(),
         Better::lower,
         peer.rms_deg(),
         cv},
        {"2-D texture pose, binary spots",
         binary.best_ms,
         "ms",
         {},
         Better::lower,
         peer.best_ms,
         cv},
        {"2-D texture pose, binary: RMS place",
         binary.rms_mm(),
         "mm",
         {},
         Better::lower,
         peer.rms_mm(),
         cv},
        {"2-D texture pose, binary: RMS turn",
         binary.rms_deg(),
         "deg",
         {},
         Better::lower,
         peer.rms_deg(),
         cv},
        {"SIFT, whole picture", own_ms, "ms", {}, Better::lower, peer_ms, "OpenCV SIFT"},
        {"SIFT, whole picture: repeatability",
         repeatability(recording, own_spots),
         "1",
         repeatability(recording, peer_spots),
         Better::higher,
         repeatability(recording, peer_spots),
         "OpenCV SIFT"},
    };
}

}  // namespace kinectlab::bench
