#include "tests/bench/lab_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "pipeline/sensor/pcd_file.hpp"
#include "pipeline/simulate/pendulum.hpp"
#include "pipeline/simulate/scene.hpp"
#include "pipeline/simulate/simulated_rig.hpp"

namespace kinectlab::bench {
namespace {

/// Distance along a ray through the camera's centre to a sphere, in lengths of the ray.
double hit_sphere(const Eigen::Vector3d& ray, const Eigen::Vector3d& centre, double radius) {
    const double a = ray.squaredNorm();
    const double b = ray.dot(centre);
    const double c = centre.squaredNorm() - radius * radius;
    const double under_root = b * b - a * c;
    if (under_root < 0.0) return std::numeric_limits<double>::infinity();
    return (b - std::sqrt(under_root)) / a;
}

void command(simulate::SimulatedRig& rig, const simulate::Command& command) {
    if (auto done = rig.apply(command); !done) throw std::runtime_error(to_text(done.error()));
}

void cast_exact(LabScene& scene, const simulate::Room& room, const Eigen::Isometry3d& T_lab_cam) {
    const Pinhole& camera = scene.camera.depth;
    scene.exact = blank_cloud(camera.width, camera.height);
    scene.true_normal.assign(scene.exact.size(), Eigen::Vector3f::Zero());
    for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d ray = camera.ray(u, v);
            const auto hit = room.cast(T_lab_cam.translation(), T_lab_cam.linear() * ray);
            const double to_bob = hit_sphere(ray, scene.bob_cam, scene.bob_radius_m);
            const double z = std::min(hit.t, to_bob);  // rays have z = 1
            if (!std::isfinite(z)) continue;
            const Eigen::Vector3d p = ray * z;
            Eigen::Vector3d normal =
                to_bob < hit.t ? Eigen::Vector3d((p - scene.bob_cam).normalized())
                               : Eigen::Vector3d(T_lab_cam.linear().transpose() * hit.normal);
            if (normal.dot(ray) > 0.0) normal = -normal;
            const auto i = static_cast<std::size_t>(v * camera.width + u);
            scene.exact.x[i] = static_cast<float>(p.x());
            scene.exact.y[i] = static_cast<float>(p.y());
            scene.exact.z[i] = static_cast<float>(p.z());
            scene.true_normal[i] = normal.cast<float>();
        }
    }
}

}  // namespace

bool LabScene::on_surface(std::size_t i) const {
    if (!seen.valid(i) || !exact.valid(i)) return false;
    const double z = exact.z[i];
    const double sigma = camera.noise.sigma_steps * camera.noise.inverse_depth_step * z * z;
    return std::abs(seen.z[i] - z) <= 5.0 * std::max(sigma, 0.001);
}

double LabScene::off_surface(std::size_t i, float x, float y, float z) const {
    const Eigen::Vector3f offset(x - exact.x[i], y - exact.y[i], z - exact.z[i]);
    return offset.dot(true_normal[i]);
}

LabScene lab_scene(simulate::NoiseModel noise, double t_s, std::uint64_t seed) {
    simulate::RigSettings settings;
    settings.noise = noise;
    settings.seed = seed;
    settings.with_colour = false;
    auto rig = simulate::SimulatedRig::create(settings);
    if (!rig) throw std::runtime_error(to_text(rig.error()));
    double now = 0.5;
    if (t_s >= 0.0) {
        command(*rig, {simulate::Action::displace, 0.35});
        rig->advance_to(now = 10.0);
        command(*rig, {simulate::Action::release});
    }
    rig->advance_to(now + std::max(t_s, 0.0));

    LabScene scene;
    scene.camera = rig->camera();
    scene.bob_radius_m = simulate::PendulumParameters().bob_radius_m;
    scene.bob_cam = rig->T_lab_cam().inverse() * rig->truth().body().p_lab;
    rig->render(scene.frame);
    scene.seen = cloud_from(scene.frame, scene.camera.depth, scene.camera.depth_unit_m);
    const simulate::Room room(simulate::pivot_of(simulate::PendulumParameters().length_m).z());
    cast_exact(scene, room, rig->T_lab_cam());
    return scene;
}

std::vector<RealCloud> real_clouds(std::size_t most) {
    namespace fs = std::filesystem;
    const char* given = std::getenv("KINECTLAB_SHARED_DATA");
    const fs::path folder =
        (given != nullptr ? fs::path(given) : fs::path("../shared/data")) / "pcl";
    std::vector<RealCloud> clouds;
    std::error_code absent;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder, absent))
        if (entry.path().filename().string().starts_with("osd_")) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        if (clouds.size() == most) break;
        std::ifstream stream(file, std::ios::binary);
        const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(stream), {});
        auto pcd = parse_pcd(bytes, file.filename().string());
        if (!pcd) throw std::runtime_error(to_text(pcd.error()));
        clouds.push_back(
            {file.stem().string(),
             {pcd->width,
              pcd->height,
              std::move(pcd->x),
              std::move(pcd->y),
              std::move(pcd->z),
              std::move(pcd->rgb)}}
        );
    }
    return clouds;
}

}  // namespace kinectlab::bench
