#include <cmath>
#include <random>

#include "pipeline/track/patch_recognition.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_shot_grouping.hpp"
#include "tests/bench/swing_frames.hpp"
#include "tests/unit/pipeline/support/mesh_room.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kScenes = 12;
constexpr double kRightM = 0.02;  // of the centre
constexpr double kRightRad = 10.0 * M_PI / 180.0;

/// Two bars joined to an angle: no turn of itself repeats it.
TriangleMesh angle_iron() {
    return test::joined(
        test::box_mesh(0.24, 0.06, 0.08), test::box_mesh(0.06, 0.10, 0.08), {0.09, 0.08, 0.0}
    );
}

/// Points spread over a mesh's triangles, one for each 25 mm².
std::vector<Eigen::Vector3f> points_on(const TriangleMesh& mesh, std::mt19937& random) {
    std::uniform_real_distribution<float> share(0.0F, 1.0F);
    std::vector<Eigen::Vector3f> points;
    for (const auto& t : mesh.triangles) {
        const Eigen::Vector3f a = mesh.vertices[t[0]], b = mesh.vertices[t[1]] - a,
                              c = mesh.vertices[t[2]] - a;
        const int count = static_cast<int>(0.5F * b.cross(c).norm() / 25e-6F);
        for (int i = 0; i < count; ++i) {
            float x = share(random), y = share(random);
            if (x + y > 1.0F) x = 1.0F - x, y = 1.0F - y;
            points.emplace_back(a + x * b + y * c);
        }
    }
    return points;
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

}  // namespace

Figures measure_recognition() {
    test::MeshRoom room(1);
    room.floor_m = 0.35;
    std::mt19937 random(1);
    const auto mesh = angle_iron();
    const auto model = std::make_shared<const ObjectModel>(make_object_model(mesh).value());
    const auto points = points_on(mesh, random);
    PatchRecogniser recogniser(room.camera, model);
    const test::Thing jar{
        test::turned_mesh({{.001, -.15}, {.05, -.15}, {.05, .15}, {.001, .15}}),
        Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.15, 1.4))};
    const test::Thing crate{
        test::box_mesh(0.3, 0.2, 0.15), Eigen::Isometry3d(Eigen::Translation3d(-0.55, 0.2, 1.5))};

    int own_right = 0, peer_right = 0;
    double own_seconds = 0.0, peer_seconds = 0.0;
    for (int i = 0; i < kScenes; ++i) {
        const Eigen::Isometry3d truth = any_pose(random);
        const auto frame = room.frame({{mesh, truth}, jar, crate});
        double start = thread_seconds();
        if (const auto fit = recogniser.find(frame.depth)) {
            Eigen::Isometry3d found = fit->T_cam_obj;
            found.translation() -= found.linear() * model->centre_obj;
            own_right += is_right(found, truth, model->centre_obj) ? 1 : 0;
        }
        own_seconds += thread_seconds() - start;
        start = thread_seconds();
        const auto theirs = find_by_shot(room.camera, frame, points, model->radius_m);
        peer_seconds += thread_seconds() - start;
        if (theirs) peer_right += is_right(*theirs, truth, model->centre_obj) ? 1 : 0;
    }
    const double own_rate = own_right / double{kScenes}, peer_rate = peer_right / double{kScenes};
    const std::string name = "recognition of a complex object";
    const std::string peer = "PCL SHOT + Hough grouping";
    return {
        {name + ", rate", own_rate, "1", peer_rate, Better::higher, peer_rate, peer},
        {name + ", time a scene",
         1e3 * own_seconds / kScenes,
         "ms",
         {},
         Better::lower,
         1e3 * peer_seconds / kScenes,
         peer}};
}

}  // namespace kinectlab::bench
