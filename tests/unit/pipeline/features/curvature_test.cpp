#include "pipeline/features/curvature.hpp"

#include <random>

#include <gtest/gtest.h>

#include "pipeline/features/surface_patch.hpp"

namespace kinectlab {
namespace {

RgbdCamera fine_camera() {
    RgbdCamera camera;
    camera.depth_unit_m = 5e-5;
    camera.noise.sigma_steps = 0.05;  // else the surface types allow for a Kinect's noise
    return camera;
}

/// A depth picture of z(ray), without noise.
template <class Surface>
std::vector<std::uint16_t> picture(const RgbdCamera& camera, const Surface& z_of) {
    std::vector<std::uint16_t> depth(640 * 480, 0);
    for (int v = 0; v < 480; ++v)
        for (int u = 0; u < 640; ++u) {
            const double z = z_of(camera.depth.ray(u, v));
            if (z > 0.0)
                depth[static_cast<std::size_t>(v * 640 + u)] =
                    static_cast<std::uint16_t>(std::lround(z / camera.depth_unit_m));
        }
    return depth;
}

/// Near side of what |a - (a·axis) axis| = r does about the centre; axis 0: a ball.
double round_z(
    const Eigen::Vector3d& ray,
    const Eigen::Vector3d& c,
    double r,
    const Eigen::Vector3d& axis,
    bool far_side = false
) {
    const Eigen::Vector3d d = ray - axis * axis.dot(ray), e = c - axis * axis.dot(c);
    const double a = d.squaredNorm(), b = d.dot(e), g = e.squaredNorm() - r * r;
    const double root = b * b - a * g;
    if (root < 0.0) return 0.0;
    return (b + (far_side ? 1.0 : -1.0) * std::sqrt(root)) / a;
}

CurvedPoint at(const std::vector<std::uint16_t>& depth, const RgbdCamera& camera, int u, int v) {
    const auto point = curved_point(depth, camera.depth, DisparityScale(camera), u, v, 0.015);
    EXPECT_TRUE(point.has_value());
    return point.value_or(CurvedPoint{});
}

TEST(Curvature, OfABallIsTheSameBothWays) {
    const auto camera = fine_camera();
    const Eigen::Vector3d c(0.05, -0.03, 0.9);
    const auto depth = picture(camera, [&](const auto& ray) {
        return round_z(ray, c, 0.08, Eigen::Vector3d::Zero());
    });
    for (const auto& [du, dv] : {std::pair{0, 0}, {15, 10}, {-20, 12}}) {
        const Eigen::Vector2d middle = camera.depth.project(c);
        const auto point =
            at(depth, camera, static_cast<int>(middle.x()) + du, static_cast<int>(middle.y()) + dv);
        EXPECT_NEAR(point.k1, -1.0 / 0.08, 0.6);
        EXPECT_NEAR(point.k2, -1.0 / 0.08, 0.6);
        EXPECT_GT(point.shape_index(), 0.97);  // a cap
        EXPECT_LT((point.normal - (point.p_cam - c).normalized()).norm(), 0.02);
        EXPECT_EQ(surface_type(point), SurfaceType::peak);
    }
}

TEST(Curvature, OfACylinderIsARidgeAlongItsAxisAndARutFromInside) {
    const auto camera = fine_camera();
    const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 0.4, 0.2).normalized(), c(0.0, 0.0, 0.9);
    const auto outside = picture(camera, [&](const auto& r) { return round_z(r, c, 0.05, axis); });
    const auto ridge = at(outside, camera, 322, 241);
    EXPECT_NEAR(ridge.k2, -20.0, 1.0);
    EXPECT_NEAR(ridge.k1, 0.0, 0.5);
    EXPECT_NEAR(ridge.shape_index(), 0.75, 0.02);
    EXPECT_GT(std::abs(ridge.direction.dot(axis)), 0.99);
    EXPECT_EQ(surface_type(ridge), SurfaceType::ridge);

    const auto inside =
        picture(camera, [&](const auto& r) { return round_z(r, c, 0.05, axis, true); });
    const auto rut = at(inside, camera, 322, 241);
    EXPECT_NEAR(rut.k1, 20.0, 1.0);
    EXPECT_NEAR(rut.shape_index(), 0.25, 0.02);
    EXPECT_EQ(surface_type(rut), SurfaceType::rut);
}

TEST(Curvature, OfASlantedPlaneIsNone) {
    const auto camera = fine_camera();
    const Eigen::Vector3d n = Eigen::Vector3d(0.5, -0.3, -1.0).normalized();
    const auto depth = picture(camera, [&](const auto& ray) { return -0.9 / n.dot(ray) * 0.8; });
    const auto point = at(depth, camera, 200, 300);
    EXPECT_LT(point.curvedness(), 0.3);
    EXPECT_EQ(surface_type(point), SurfaceType::flat);
    EXPECT_LT((point.normal - n).norm(), 0.01);
}

TEST(Curvature, IsAsUncertainAsItSays) {
    const RgbdCamera camera;  // a Kinect's noise
    std::mt19937 random(3);
    std::normal_distribution<> noise(0.0, 0.5);
    double squares = 0.0, said = 0.0;
    int count = 0;
    std::vector<std::uint16_t> depth(640 * 480);
    for (auto& counts : depth)
        counts = static_cast<std::uint16_t>(
            std::lround(1000.0 / (2.85e-3 * std::round(1.0 / (2.85e-3 * 0.8) + noise(random))))
        );
    for (int v = 40; v < 440; v += 23)
        for (int u = 40; u < 600; u += 23) {
            const auto point = at(depth, camera, u, v);
            squares += point.k1 * point.k1 + point.k2 * point.k2;
            said += 2.0 * point.sigma_k * point.sigma_k;
            ++count;
        }
    EXPECT_NEAR(std::sqrt(squares / said), 1.0, 0.5) << count;
}

TEST(Curvature, NothingWhereNothingIs) {
    const RgbdCamera camera;
    std::vector<std::uint16_t> depth(640 * 480, 0);
    const DisparityScale scale(camera);
    EXPECT_FALSE(curved_point(depth, camera.depth, scale, 100, 100, 0.02).has_value());
    depth[100 * 640 + 100] = 1000;  // one reading alone
    EXPECT_FALSE(curved_point(depth, camera.depth, scale, 100, 100, 0.02).has_value());
    EXPECT_TRUE(find_surface_patches(depth, camera, {}).empty());
    depth.assign(depth.size(), 65535);
    EXPECT_TRUE(find_surface_patches(depth, camera, {}).empty());
}

}  // namespace
}  // namespace kinectlab
