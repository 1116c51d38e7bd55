#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "pipeline/track/patch_recognition.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_oriented_scene.hpp"
#include "tests/bench/peer_ppf.hpp"
#include "tests/bench/peer_shot_grouping.hpp"
#include "tests/bench/swing_frames.hpp"
#include "tests/unit/pipeline/support/mesh_room.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kScenes = 36;
constexpr int kPeerScenes = 6;    // the first ones: a peer takes many seconds for each
constexpr double kRightM = 0.02;  // of the centre
constexpr double kRightRad = 10.0 * M_PI / 180.0;

/// Two bars joined to an angle: no turn of itself repeats it.
TriangleMesh angle_iron() {
    return test::joined(
        test::box_mesh(0.24, 0.06, 0.08), test::box_mesh(0.06, 0.10, 0.08), {0.09, 0.08, 0.0}
    );
}

/// Points spread over a mesh's triangles, one for each 25 mm²; their normals point away from the
/// middle of the part they lie on.
OrientedPoints points_on(const TriangleMesh& mesh, std::mt19937& random) {
    std::uniform_real_distribution<float> share(0.0F, 1.0F);
    OrientedPoints cloud;
    for (const auto& t : mesh.triangles) {
        const Eigen::Vector3f a = mesh.vertices[t[0]], b = mesh.vertices[t[1]] - a,
                              c = mesh.vertices[t[2]] - a;
        const int count = static_cast<int>(0.5F * b.cross(c).norm() / 25e-6F);
        for (int i = 0; i < count; ++i) {
            float x = share(random), y = share(random);
            if (x + y > 1.0F) x = 1.0F - x, y = 1.0F - y;
            cloud.points.emplace_back(a + x * b + y * c);
            cloud.normals.push_back(b.cross(c).normalized());
        }
    }
    return cloud;
}

Eigen::Isometry3d any_pose(std::mt19937& random) {
    std::uniform_real_distribution<> u(-1.0, 1.0);
    std::normal_distribution<> n;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::Quaterniond(n(random), n(random), n(random), n(random))
                     .normalized()
                     .toRotationMatrix();
    T.translation() = Eigen::Vector3d(0.3 * u(random), 0.15 * u(random), 1.0 + 0.2 * u(random));
    return T;
}

bool is_right(
    const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth, const Eigen::Vector3d& centre
) {
    const Eigen::AngleAxisd turned(found.linear() * truth.linear().transpose());
    return (found * centre - truth * centre).norm() < kRightM && turned.angle() < kRightRad;
}

constexpr int kNearerCounts = 120;  // than the scene without it: of what was put there

/// The pixels of what was put into a scene, as change detection gives them to the trackers.
std::vector<std::uint32_t> moved_pixels(const RgbdFrame& frame, const RgbdFrame& before) {
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t i = 0; i < frame.depth.size(); ++i)
        if (frame.depth[i] > 0 && frame.depth[i] + kNearerCounts < before.depth[i])
            pixels.push_back(i);
    return pixels;
}

/// What one way to find the object reached.
struct Tally {
    int scenes = 0, right = 0, wrong = 0;
    double seconds = 0.0;

    template <class IsRight>
    void add(const std::optional<Eigen::Isometry3d>& found, IsRight is_right, double took) {
        ++scenes;
        seconds += took;
        if (found) ++(is_right(*found) ? right : wrong);
    }
    [[nodiscard]] double rate() const { return right / static_cast<double>(scenes); }
    [[nodiscard]] double wrong_rate() const { return wrong / static_cast<double>(scenes); }
    [[nodiscard]] double ms() const { return 1e3 * seconds / scenes; }
};

}  // namespace

Figures measure_recognition() {
    test::MeshRoom room(1);
    room.floor_m = 0.35;
    std::mt19937 random(1);
    const auto mesh = angle_iron();
    const auto model = std::make_shared<const ObjectModel>(make_object_model(mesh).value());
    const auto points = points_on(mesh, random);
    PpfDetector ppf_detector(points);
    PatchRecogniser recogniser(room.camera, model);
    const test::Thing jar{
        test::turned_mesh({{.001, -.15}, {.05, -.15}, {.05, .15}, {.001, .15}}),
        Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.15, 1.4))};
    const test::Thing crate{
        test::box_mesh(0.3, 0.2, 0.15), Eigen::Isometry3d(Eigen::Translation3d(-0.55, 0.2, 1.5))};

    const auto before = room.frame({jar, crate});
    Tally own, moved, shot, ppf, own_where_peers_looked;
    for (int i = 0; i < kScenes; ++i) {
        const Eigen::Isometry3d truth = any_pose(random);
        const auto frame = room.frame({{mesh, truth}, jar, crate});
        const auto right = [&](const Eigen::Isometry3d& found) {
            return is_right(found, truth, model->centre_obj);
        };
        double start = thread_seconds();
        std::optional<Eigen::Isometry3d> found;
        if (const auto fit = recogniser.find(frame.depth)) {
            found = fit->T_cam_obj;
            found->translation() -= found->linear() * model->centre_obj;
        }
        own.add(found, right, thread_seconds() - start);
        const auto pixels = moved_pixels(frame, before);
        const std::array<std::span<const std::uint32_t>, 1> segments{pixels};
        start = thread_seconds();
        std::optional<Eigen::Isometry3d> found_moved;
        if (const auto fit = recogniser.find_moved(frame.depth, segments)) {
            found_moved = fit->T_cam_obj;
            found_moved->translation() -= found_moved->linear() * model->centre_obj;
        }
        moved.add(found_moved, right, thread_seconds() - start);
        if (i >= kPeerScenes) continue;
        own_where_peers_looked.add(found, right, 0.0);
        start = thread_seconds();
        const auto scene =
            oriented_scene(room.camera, frame, room.wall_m - 0.1, room.floor_m - 0.02);
        const double normals = thread_seconds() - start;
        start = thread_seconds();
        const auto by_shot = find_by_shot(points, scene);
        shot.add(by_shot, right, normals + thread_seconds() - start);
        start = thread_seconds();
        const auto by_ppf = ppf_detector.find(scene);
        ppf.add(by_ppf, right, normals + thread_seconds() - start);
    }
    const bool ppf_is_better = PpfDetector::is_installed() && ppf.rate() >= shot.rate();
    const Tally& best = ppf_is_better ? ppf : shot;
    const std::string peer = ppf_is_better ? "OpenCV PPF + ICP" : "PCL SHOT + Hough grouping";
    const std::string name = "recognition of a complex object";
    return {
        {name + ", rate in the peers' scenes",
         own_where_peers_looked.rate(),
         "1",
         best.rate(),
         Better::higher,
         best.rate(),
         peer},
        {name + ", rate in all scenes", own.rate(), "1", {}, Better::higher},
        {name + ", taken for it where it is not",
         own.wrong_rate(),
         "1",
         0.0,
         Better::lower,
         best.wrong_rate(),
         peer},
        {name + ", time a scene", own.ms(), "ms", {}, Better::lower, best.ms(), peer},
        {name + ", rate in what moved", moved.rate(), "1", {}, Better::higher},
        {name + ", taken for it in what moved", moved.wrong_rate(), "1", 0.0, Better::lower},
        {name + ", time in what moved", moved.ms(), "ms", {}, Better::lower}};
}

}  // namespace kinectlab::bench
