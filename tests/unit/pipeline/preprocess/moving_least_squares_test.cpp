#include "pipeline/preprocess/moving_least_squares.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/cloud_scenes.hpp"

namespace kinectlab {
namespace {

using namespace test;

/// Equation 4 at one pixel, written down as it stands, in double precision.
struct ByFormula {
    double value = 0.0;
    int neighbours = 0;
};
ByFormula by_formula(
    const Cloud& cloud,
    const Pinhole& camera,
    const MovingLeastSquaresSettings& settings,
    int u0,
    int v0
) {
    const int size = settings.basis == Basis::quadratic ? 6 : 3;
    const double z0 = cloud.z[static_cast<std::size_t>(v0 * camera.width + u0)];
    const double gate = settings.radius_m + 3.0 * settings.depth_noise_per_m * z0 * z0;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    ByFormula result;
    for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
            const double f = cloud.z[static_cast<std::size_t>(v * camera.width + u)];
            const double x = (u - u0) / camera.fx * z0;
            const double y = (v - v0) / camera.fy * z0;
            const double d = std::hypot(x, y);
            if (!(d <= settings.radius_m) || !(std::abs(f - z0) <= gate)) continue;
            ++result.neighbours;
            const double theta = 1.0 / (d * d + settings.epsilon_m * settings.epsilon_m);
            Eigen::VectorXd b(6);
            b << 1.0, x, y, x * y, x * x, y * y;
            matrix += theta * b.head(size) * b.head(size).transpose();
            right += theta * f * b.head(size);
        }
    }
    result.value = matrix.ldlt().solve(right)[0];
    return result;
}

TEST(MovingLeastSquares, IsEquationFour) {
    const Pinhole camera = small_camera();
    const Cloud scene = messy_scene(camera, 1);
    for (const Basis basis : {Basis::linear, Basis::quadratic}) {
        for (const double epsilon : {0.005, 0.06}) {
            const MovingLeastSquaresSettings settings{basis, 0.06, epsilon};
            const auto smoothed = smooth_organised(scene, camera, settings);
            ASSERT_TRUE(smoothed) << to_text(smoothed.error());
            int compared = 0;
            for (int v = 0; v < camera.height; ++v) {
                for (int u = 0; u < camera.width; ++u) {
                    const auto i = static_cast<std::size_t>(v * camera.width + u);
                    if (!scene.valid(i)) {
                        EXPECT_FALSE(smoothed->cloud.valid(i));
                        EXPECT_EQ(smoothed->fitted[i], Smoothed::kNoFit);
                        continue;
                    }
                    if (smoothed->fitted[i] != static_cast<int>(basis)) continue;
                    const auto expected = by_formula(scene, camera, settings, u, v);
                    if (expected.neighbours < 25) continue;
                    ASSERT_NEAR(smoothed->cloud.z[i], expected.value, 3e-5) << u << ", " << v;
                    ++compared;
                }
            }
            EXPECT_GT(compared, 2000);
        }
    }
}

TEST(MovingLeastSquares, PointsStayOnTheirViewingRays) {
    const Pinhole camera = small_camera();
    const Cloud scene = messy_scene(camera, 2);
    const auto smoothed = smooth_organised(scene, camera, {Basis::quadratic, 0.06, 0.06});
    ASSERT_TRUE(smoothed);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        if (!scene.valid(i)) continue;
        const Eigen::Vector3f before = point(scene, i), after = point(smoothed->cloud, i);
        EXPECT_NEAR(before.cross(after).norm(), 0.0F, 1e-6F);
    }
}

/// Distances to the plane n·p = d before and after, root mean square.
struct Rms {
    double before = 0.0, after = 0.0;
};
Rms off_plane(const Cloud& seen, const Cloud& smoothed, const Eigen::Vector3d& n, double d) {
    Rms rms;
    double count = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!seen.valid(i)) continue;
        rms.before += std::pow(n.dot(point(seen, i).cast<double>()) - d, 2);
        rms.after += std::pow(n.dot(point(smoothed, i).cast<double>()) - d, 2);
        count += 1.0;
    }
    return {std::sqrt(rms.before / count), std::sqrt(rms.after / count)};
}

Cloud noisy_plane(const Pinhole& camera, const Eigen::Vector3d& n, double d, double sigma) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, sigma);
    return render(camera, [&](int, int, const Eigen::Vector3d& ray) {
        return plane_depth(n, d, ray) + noise(random);
    });
}

TEST(MovingLeastSquares, TakesTheNoiseOffASlantedPlane) {
    const Pinhole camera = small_camera();
    const Eigen::Vector3d n = Eigen::Vector3d(0.5, -0.2, -1).normalized();
    const Cloud seen = noisy_plane(camera, n, -1.0, 0.004);
    for (const Basis basis : {Basis::linear, Basis::quadratic}) {
        const MovingLeastSquaresSettings settings{basis, 0.08, 0.08};
        const auto picture = smooth_organised(seen, camera, settings);
        ASSERT_TRUE(picture);
        const Rms rms = off_plane(seen, picture->cloud, n, -1.0);
        EXPECT_LT(rms.after, 0.35 * rms.before);
        const auto list = smooth_unorganised(as_list(seen), settings);
        ASSERT_TRUE(list);
        const Rms list_rms = off_plane(seen, list->cloud, n, -1.0);
        EXPECT_LT(list_rms.after, 0.35 * list_rms.before);
    }
}

TEST(MovingLeastSquares, LeavesAnExactPlaneWhereItIs) {
    const Pinhole camera = small_camera();
    const Eigen::Vector3d n = Eigen::Vector3d(0.3, 0.4, -1).normalized();
    const Cloud seen = noisy_plane(camera, n, -1.0, 0.0);
    const auto smoothed = smooth_organised(seen, camera, {Basis::quadratic, 0.05, 0.02});
    ASSERT_TRUE(smoothed);
    EXPECT_LT(off_plane(seen, smoothed->cloud, n, -1.0).after, 2e-5);
}

TEST(MovingLeastSquares, DoesNotSmearOneSurfaceIntoAnother) {
    const Pinhole camera = small_camera();
    const Cloud step = render(camera, [](int u, int, const auto&) { return u < 32 ? 1.0 : 1.4; });
    const auto smoothed = smooth_organised(step, camera, {Basis::quadratic, 0.06, 0.06});
    ASSERT_TRUE(smoothed);
    for (std::size_t i = 0; i < step.size(); ++i)
        EXPECT_NEAR(smoothed->cloud.z[i], step.z[i], 1e-4);
}

TEST(MovingLeastSquares, SimplerBasesServeWhereTooLittleIsSeen) {
    const Pinhole camera = small_camera();
    const auto alone = [](int u, int v, const auto&) {
        return u == 30 && v == 20 ? 1.0 : 0.0;
    };
    const auto row = [](int, int v, const auto&) {
        return v == 20 ? 1.0 : 0.0;
    };
    const auto five = [](int u, int v, const auto&) {
        return std::abs(u - 30) <= 1 && std::abs(v - 20) <= 1 ? 1.0 : 0.0;
    };
    const MovingLeastSquaresSettings settings{Basis::quadratic, 0.06, 0.06};
    const std::size_t middle = 20 * 64 + 30;
    const auto fit = [&](const auto& depth) {
        return smooth_organised(render(camera, depth), camera, settings).value();
    };
    EXPECT_EQ(fit(alone).fitted[middle], 0);
    EXPECT_EQ(fit(alone).cloud.z[middle], 1.0F);
    EXPECT_EQ(fit(row).fitted[middle], 0) << "points in a line do not tell a plane";
    EXPECT_EQ(fit(five).fitted[middle], 1) << "nine points are too few for six coefficients";
    EXPECT_NEAR(fit(five).cloud.z[middle], 1.0, 1e-6);
}

TEST(MovingLeastSquares, AListKnowsNoPreferredDirection) {
    std::vector<Eigen::Vector3f> points;
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0.0F, 0.002F);
    for (int i = 0; i < 30; ++i)
        for (int k = 0; k < 30; ++k) {
            const float x = 0.005F * static_cast<float>(i - 15),
                        y = 0.005F * static_cast<float>(k - 15);
            points.emplace_back(x, y, 3.0F * x * x - y * y + x * y + noise(random));
        }
    const MovingLeastSquaresSettings settings{Basis::quadratic, 0.025, 0.025};
    const auto straight = smooth_unorganised(list_of(points), settings);
    ASSERT_TRUE(straight);
    const Eigen::Matrix3f turn =
        Eigen::AngleAxisf(1.3F, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix();
    std::vector<Eigen::Vector3f> turned;
    for (const auto& p : points)
        turned.push_back(turn * p);
    const auto after = smooth_unorganised(list_of(turned), settings);
    ASSERT_TRUE(after);
    double squares_before = 0.0, squares_after = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(
            (turn * point(straight->cloud, i) - point(after->cloud, i)).norm(), 0.0F, 2e-4F
        );
        const auto off = [](const Eigen::Vector3f& p) {
            return p.z() - (3.0F * p.x() * p.x() - p.y() * p.y() + p.x() * p.y());
        };
        squares_before += std::pow(off(points[i]), 2);
        squares_after += std::pow(off(point(straight->cloud, i)), 2);
    }
    EXPECT_LT(squares_after, 0.2 * squares_before);
}

TEST(MovingLeastSquares, ListsThatShowNoSurface) {
    const MovingLeastSquaresSettings settings{Basis::quadratic, 0.05, 0.05};
    const auto fit = [&](const std::vector<Eigen::Vector3f>& points) {
        return smooth_unorganised(list_of(points), settings).value();
    };
    EXPECT_EQ(point(fit({{0, 0, 1}}).cloud, 0), Eigen::Vector3f(0, 0, 1));
    const auto equal = fit(std::vector<Eigen::Vector3f>(3000, {0.1F, 0.2F, 1.0F}));
    EXPECT_NEAR((point(equal.cloud, 17) - Eigen::Vector3f(0.1F, 0.2F, 1.0F)).norm(), 0.0F, 1e-6F);
    std::vector<Eigen::Vector3f> line;
    for (int i = 0; i < 200; ++i)
        line.emplace_back(0.001F * static_cast<float>(i), 0.0F, 1.0F);
    const auto straight = fit(line);
    for (std::size_t i = 0; i < line.size(); ++i) {
        ASSERT_TRUE(straight.cloud.valid(i));
        EXPECT_NEAR((point(straight.cloud, i) - line[i]).norm(), 0.0F, 1e-4F);
    }
}

TEST(MovingLeastSquares, NothingToSeeComesBackAsItIs) {
    const Pinhole camera = small_camera();
    const auto picture = smooth_organised(blank_cloud(64, 48), camera, {});
    ASSERT_TRUE(picture);
    EXPECT_FALSE(picture->cloud.valid(0));
    EXPECT_TRUE(smooth_unorganised(Cloud{}, {}));
    EXPECT_TRUE(smooth_unorganised(blank_cloud(10, 1), {}));
}

TEST(MovingLeastSquares, RefusesWhatCannotBe) {
    const Pinhole camera = small_camera();
    const Cloud scene = messy_scene(camera, 4);
    const auto field = [](const auto& result) {
        return result ? std::string() : result.error().field;
    };
    for (const double wrong : {0.0, -0.02, std::nan(""), HUGE_VAL}) {
        EXPECT_EQ(field(smooth_organised(scene, camera, {Basis::linear, wrong})), "radius_m");
        EXPECT_EQ(field(smooth_unorganised(scene, {Basis::linear, 0.02, wrong})), "epsilon_m");
    }
    EXPECT_EQ(field(smooth_organised(scene, camera, {Basis::linear, 2.0})), "radius_m");
    EXPECT_EQ(field(smooth_organised(as_list(scene), camera, {})), "cloud");
    Cloud behind = scene;
    for (auto& z : behind.z)
        z = -z;
    EXPECT_EQ(field(smooth_organised(behind, camera, {})), "cloud");
}

TEST(MovingLeastSquares, SmoothsARealFrame) {
    const auto path = shared_data("pcl/osd_learn5.pcd");
    if (path.empty()) GTEST_SKIP() << "needs the shared data: set KINECTLAB_SHARED_DATA";
    const auto cloud = read_pcd(path);
    ASSERT_TRUE(cloud) << to_text(cloud.error());
    const auto smoothed = smooth_organised(*cloud, Pinhole{}, {});
    ASSERT_TRUE(smoothed) << to_text(smoothed.error());
    // Neighbouring pixels lie closer to one another afterwards, and no point has jumped.
    double before = 0.0, after = 0.0, quadratic = 0.0, valid = 0.0;
    for (std::size_t i = 1; i + 1 < cloud->size(); ++i) {
        if (!cloud->valid(i)) continue;
        valid += 1.0;
        quadratic += smoothed->fitted[i] == 2 ? 1.0 : 0.0;
        EXPECT_NEAR(smoothed->cloud.z[i], cloud->z[i], 0.05);
        if (!cloud->valid(i - 1) || !cloud->valid(i + 1)) continue;
        const auto bend = [i](const std::vector<float>& z) {
            return z[i - 1] - 2 * z[i] + z[i + 1];
        };
        if (std::abs(bend(cloud->z)) > 0.01F) continue;
        before += std::abs(bend(cloud->z));
        after += std::abs(bend(smoothed->cloud.z));
    }
    EXPECT_GT(quadratic, 0.9 * valid);
    EXPECT_LT(after, 0.4 * before);
}

}  // namespace
}  // namespace kinectlab
