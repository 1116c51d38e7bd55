#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "pipeline/features/sift.hpp"
#include "pipeline/track/tracker.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_sift_pose.hpp"
#include "tests/bench/swing_frames.hpp"
#include "tests/unit/pipeline/support/textured_scene.hpp"

namespace kinectlab::bench {
namespace {

using test::PrintedBox;
using test::TexturedScene;

constexpr int kFrames = 20;

/// Where a frame is looked at: around the last place, or all of it as when the object is sought.
enum class Look { near, everywhere };

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Processor time, which a busy machine lengthens less than the clock's.
template <class Work>
double ms_of(Work&& work) {
    const double start = thread_seconds();
    work();
    return 1e3 * (thread_seconds() - start);
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
    std::vector<double> ms;
    void add(const Eigen::Vector3d& off_m, const Eigen::Matrix3d& off_turn, double took_ms) {
        squares_m += off_m.squaredNorm();
        squares_rad += std::pow(Eigen::AngleAxisd(off_turn).angle(), 2);
        ++found;
        ms.push_back(took_ms);
    }
    [[nodiscard]] double rms_mm() const { return 1e3 * std::sqrt(squares_m / std::max(1, found)); }
    [[nodiscard]] double rms_deg() const {
        return 57.29578 * std::sqrt(squares_rad / std::max(1, found));
    }
};

Accuracy own(const Recording& recording, TextureSpots spots, Look look) {
    const TextureSettings settings{.box = recording.first_look, .spots = spots};
    const std::vector<ObjectSpec> objects{{"box", settings}};
    const auto trackers = make_trackers(recording.camera, objects).value();
    Accuracy accuracy;
    std::vector<TrackSample> samples;
    TrackSample first;
    for (std::size_t i = 0; i < recording.frames.size(); ++i) {
        samples.clear();
        RgbdFrame frame = recording.frames[i];
        // After two seconds the tracker has forgotten the last place.
        frame.t =
            static_cast<TimeNs>(i) * (look == Look::near ? kNsPerSecond / 30 : 2 * kNsPerSecond);
        const double ms = ms_of([&] { trackers.front()->track(frame, {}, samples); });
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

Accuracy stock(const Recording& recording, Look look) {
    const PictureBox& box = recording.first_look;
    OpenCvSiftPose peer(
        recording.camera, recording.frames[0], box.left, box.top, box.width, box.height
    );
    Accuracy accuracy;
    const Eigen::Vector3d middle = recording.boxes[0].T_cam_box.translation() -
                                   Eigen::Vector3d(0.0, 0.0, recording.boxes[0].half_m.z());
    for (std::size_t i = 1; i < recording.frames.size(); ++i) {
        if (look == Look::everywhere) peer.forget_place();
        std::optional<Eigen::Isometry3d> motion;
        const double ms = ms_of([&] { motion = peer.motion(recording.frames[i]); });
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

/// The pose's figures of one kind of spots beside OpenCV's, which looks where this one does.
void add_pose_figures(const Recording& recording, TextureSpots spots, Look look, Figures& figures) {
    const Accuracy mine = own(recording, spots, look);
    const Accuracy peer = stock(recording, look);
    const bool sift = spots == TextureSpots::sift;
    const std::string name = std::string("2-D texture pose, ") + (sift ? "SIFT" : "binary") +
                             (look == Look::near ? " around last place" : " whole picture");
    const std::string cv = "OpenCV SIFT + PnP";
    const auto add =
        [&](const char* what, double value, const char* unit, double other, Better better) {
            figures.push_back({name + what, value, unit, {}, better, other, cv});
        };
    const double frames = kFrames - 1;
    const double peer_ms = median(peer.ms);
    add("", median(mine.ms), "ms", peer_ms, Better::lower);
    if (sift) figures.back().bound = peer_ms / 3;
    add(": found", mine.found / frames, "1", peer.found / frames, Better::higher);
    add(": RMS place", mine.rms_mm(), "mm", peer.rms_mm(), Better::lower);
    if (sift) figures.back().bound = peer.rms_mm();
    add(": RMS turn", mine.rms_deg(), "deg", peer.rms_deg(), Better::lower);
    if (sift) figures.back().bound = peer.rms_deg();
}

/// Spots alone, of whole pictures: how long, how many, how many of them again.
void add_spot_figures(const Recording& recording, Figures& figures) {
    Sift whole;
    std::vector<std::vector<Keypoint2d>> own_spots, peer_spots;
    std::vector<double> own_ms, peer_ms;
    double own_count = 0.0, peer_count = 0.0;
    for (const auto& frame : recording.frames) {
        const Pinhole& k = recording.camera.colour;
        own_ms.push_back(ms_of([&] { whole.find(frame.rgb, k.width, {0, 0, k.width, k.height}); }));
        own_spots.emplace_back(whole.keypoints().begin(), whole.keypoints().end());
        peer_ms.push_back(ms_of([&] { peer_spots.push_back(opencv_sift(recording.camera, frame)); })
        );
        own_count += static_cast<double>(own_spots.back().size()) / kFrames;
        peer_count += static_cast<double>(peer_spots.back().size()) / kFrames;
    }
    const std::string cv = "OpenCV SIFT";
    const double stock_ms = median(peer_ms);
    const double again = repeatability(recording, peer_spots);
    figures.push_back(
        {"SIFT, whole picture", median(own_ms), "ms", stock_ms / 3, Better::lower, stock_ms, cv}
    );
    figures.push_back(
        {"SIFT, whole picture: spots", own_count, "1", {}, Better::higher, peer_count, cv}
    );
    figures.push_back(
        {"SIFT, whole picture: repeatability",
         repeatability(recording, own_spots),
         "1",
         again,
         Better::higher,
         again,
         cv}
    );
}

}  // namespace

Figures measure_texture_pose() {
    const Recording recording = record();
    Figures figures;
    for (const Look look : {Look::near, Look::everywhere})
        for (const TextureSpots spots : {TextureSpots::sift, TextureSpots::binary})
            add_pose_figures(recording, spots, look, figures);
    add_spot_figures(recording, figures);
    return figures;
}

}  // namespace kinectlab::bench
