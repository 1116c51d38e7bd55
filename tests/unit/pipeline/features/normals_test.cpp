#include "pipeline/features/normals.hpp"

#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/unit/pipeline/support/cloud_scenes.hpp"

namespace kinectlab {
namespace {

using namespace test;

Eigen::Vector3d normal_at(const NormalImage& image, int u, int v) {
    const auto i = static_cast<std::size_t>(v * image.width + u);
    return Eigen::Vector3f(image.x[i], image.y[i], image.z[i]).cast<double>();
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

RC_GTEST_PROP(Normals, OfAnyPlaneEverywhere, ()) {
    const Pinhole camera = small_camera();
    const auto part = [] {
        return 0.01 * *rc::gen::inRange(-80, 80);
    };
    const Eigen::Vector3d n = Eigen::Vector3d(part(), part(), -1.0).normalized();
    const Cloud plane = render(camera, [&](int u, int v, const Eigen::Vector3d& ray) {
        return (u * 7 + v * 13) % 29 == 0 ? 0.0 : plane_depth(n, -1.0, ray);
    });
    NormalSettings settings;
    settings.half_window = *rc::gen::inRange(1, 9);
    settings.max_jump_per_m = 1.0;
    const auto found = find_normals(plane, camera, settings);
    RC_ASSERT(found.has_value());
    int seen = 0;
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d normal = normal_at(*found, u, v);
            const bool reading = plane.valid(static_cast<std::size_t>(v * camera.width + u));
            if (!normal.allFinite()) continue;
            RC_ASSERT(reading);
            RC_ASSERT(angle_deg(normal, n) < 0.05);
            ++seen;
        }
    RC_ASSERT(seen > 0.9 * camera.width * camera.height);
}

TEST(Normals, OfASphereAreItsRadii) {
    const Pinhole camera = small_camera(128, 96);
    const Eigen::Vector3d centre(0.02, -0.03, 1.0);
    constexpr double kRadius = 0.3;
    const Cloud ball = render(camera, [&](int, int, const Eigen::Vector3d& ray) {
        const double a = ray.squaredNorm(), b = ray.dot(centre);
        const double root = b * b - a * (centre.squaredNorm() - kRadius * kRadius);
        return root < 0.0 ? 0.0 : (b - std::sqrt(root)) / a;
    });
    NormalSettings settings;
    settings.half_window = 3;
    const auto found = find_normals(ball, camera, settings);
    ASSERT_TRUE(found);
    int seen = 0;
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            const auto i = static_cast<std::size_t>(v * camera.width + u);
            const Eigen::Vector3d normal = normal_at(*found, u, v);
            if (!normal.allFinite()) continue;
            const Eigen::Vector3d p = point(ball, i).cast<double>();
            const Eigen::Vector3d radius = (p - centre).normalized();
            EXPECT_NEAR(normal.norm(), 1.0, 1e-5);
            EXPECT_LT(normal.dot(p), 0.0) << "towards the camera";
            if (-radius.dot(p.normalized()) < 0.6) continue;  // curved away: half the window
            EXPECT_LT(angle_deg(normal, radius), 1.0) << u << ", " << v;
            ++seen;
        }
    EXPECT_GT(seen, 1000);
}

TEST(Normals, AStepDoesNotTiltTheSurfacesBesideIt) {
    const Pinhole camera = small_camera();
    const Cloud step = render(camera, [](int u, int, const auto&) { return u < 32 ? 1.0 : 1.5; });
    const auto found = find_normals(step, camera);
    ASSERT_TRUE(found);
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u)
            EXPECT_LT(angle_deg(normal_at(*found, u, v), {0, 0, -1}), 0.05) << u << ", " << v;
}

TEST(Normals, NoReadingOrTooFewNeighboursIsNoNormal) {
    const Pinhole camera = small_camera();
    const auto alone = [](int u, int v, const auto&) {
        return u == 30 && v == 20 ? 1.0 : 0.0;
    };
    const auto row = [](int, int v, const auto&) {
        return v == 20 ? 1.0 : 0.0;
    };
    for (const Cloud& cloud : {render(camera, alone), render(camera, row), blank_cloud(64, 48)}) {
        const auto found = find_normals(cloud, camera);
        ASSERT_TRUE(found);
        for (const float x : found->x)
            EXPECT_TRUE(std::isnan(x));
    }
}

TEST(Normals, OfTheSmallestPictures) {
    for (const int side : {1, 2, 7, 9}) {
        const Pinhole camera = small_camera(side, side);
        const Cloud wall = render(camera, [](int, int, const auto&) { return 1.0; });
        EXPECT_TRUE(find_normals(wall, camera)) << side;
    }
    EXPECT_TRUE(find_normals(Cloud{}, small_camera(0, 0)));
}

TEST(Normals, RefusesWhatCannotBe) {
    const Pinhole camera = small_camera();
    const Cloud wall = render(camera, [](int, int, const auto&) { return 1.0; });
    const auto field = [&](int half, double jump, double share) {
        const auto found = find_normals(wall, camera, {half, jump, share});
        return found ? std::string() : found.error().field;
    };
    EXPECT_EQ(field(0, 0.02, 0.01), "half_window");
    EXPECT_EQ(field(-2, 0.02, 0.01), "half_window");
    EXPECT_EQ(field(17, 0.02, 0.01), "half_window");
    EXPECT_EQ(field(5, 0.0, 0.01), "max_jump_per_m");
    EXPECT_EQ(field(5, std::nan(""), 0.01), "max_jump_per_m");
    EXPECT_EQ(field(5, 0.02, -1.0), "max_jump_share");
    EXPECT_EQ(find_normals(as_list(wall), camera).error().field, "cloud");
}

TEST(Normals, CoverARealFrame) {
    const auto path = shared_data("pcl/osd_learn5.pcd");
    if (path.empty()) GTEST_SKIP() << "needs the shared data: set KINECTLAB_SHARED_DATA";
    const auto cloud = read_pcd(path);
    ASSERT_TRUE(cloud) << to_text(cloud.error());
    const auto found = find_normals(*cloud, Pinhole{});
    ASSERT_TRUE(found);
    double readings = 0.0, normals = 0.0;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
        readings += cloud->valid(i) ? 1.0 : 0.0;
        if (std::isnan(found->x[i])) continue;
        normals += 1.0;
        const Eigen::Vector3f n(found->x[i], found->y[i], found->z[i]);
        EXPECT_NEAR(n.norm(), 1.0F, 1e-4F);
        EXPECT_LT(n.dot(point(*cloud, i)), 0.0F);
    }
    EXPECT_GT(normals, 0.95 * readings);
}

}  // namespace
}  // namespace kinectlab
