#include "pipeline/track/shapes.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab {
namespace {

using test::ShapeRoom;

ShapeDetector detector_for(const RgbdCamera& camera, const ShapesSettings& settings = {}) {
    auto detector = ShapeDetector::create(camera, settings);
    EXPECT_TRUE(detector);
    return std::move(*detector);
}

/// The found shape with most pixels of one face of a solid, and the share of that face it has.
struct Match {
    const SceneShape* shape = nullptr;
    double share = 0.0;
    double purity = 0.0;
};
Match match(std::span<const SceneShape> shapes, const ShapeRoom& room, int solid, int face) {
    Match best;
    const auto all = static_cast<double>(room.pixels_of(solid, face).size());
    for (const auto& shape : shapes) {
        double own = 0.0;
        for (const auto pixel : shape.pixels)
            own += room.solid_at[pixel] == solid && room.face_at[pixel] == face ? 1.0 : 0.0;
        if (own / all > best.share)
            best = {&shape, own / all, own / static_cast<double>(shape.pixels.size())};
    }
    return best;
}

TEST(Shapes, AllKindsInOneScene) {
    ShapeRoom room(31);
    const Eigen::Vector3d up = Eigen::Vector3d(0.0, -0.8, -0.6).normalized();
    const Eigen::Vector3d foot(0.0, 0.2, 1.2), back = up.cross(Eigen::Vector3d::UnitX());
    const auto on_table = [&](double x, double y) {
        return Eigen::Vector3d(foot + x * Eigen::Vector3d::UnitX() + y * back);
    };
    room.solids = {
        test::wall(foot, up),
        test::wall({0, 0, 2.2}, {0.1, 0.05, -1}),
        test::ball(on_table(-0.28, 0.05) + 0.08 * up, 0.08),
        test::can(on_table(0.0, 0.0), up, 0.05, 0.2),
        test::cone(on_table(0.3, 0.05) + 0.24 * up, -up, 0.36, 0.02, 0.24)};
    auto detector = detector_for(room.camera);
    const RgbdFrame frame = room.frame();
    const auto shapes = detector.detect(frame.depth);

    const std::array kinds{
        ShapeKind::plane,
        ShapeKind::plane,
        ShapeKind::sphere,
        ShapeKind::cylinder,
        ShapeKind::cone};
    std::array<Match, 5> found;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        found[i] = match(shapes, room, static_cast<int>(i), 0);
        ASSERT_NE(found[i].shape, nullptr) << i;
        EXPECT_EQ(found[i].shape->fit.shape.kind, kinds[i]) << i;
        EXPECT_GT(found[i].share, 0.9) << i;
        EXPECT_GT(found[i].purity, 0.95) << i;
    }
    const Shape& ball = found[2].shape->fit.shape;
    EXPECT_LT((ball.point - room.solids[2].place).norm(), 1e-3);
    EXPECT_NEAR(ball.size, 0.08, 1e-3);
    const Shape& can = found[3].shape->fit.shape;
    EXPECT_NEAR(can.size, 0.05, 1e-3);
    EXPECT_LT(can.axis.cross(up).norm(), 0.01);
    const Shape& cone = found[4].shape->fit.shape;
    EXPECT_NEAR(cone.size, 0.36, 0.01);
    EXPECT_LT((cone.point - room.solids[4].place).norm(), 3e-3);

    // Biggest first, and no pixel belongs to two.
    std::vector<int> owners(frame.depth.size(), 0);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (i > 0) {
            EXPECT_GE(shapes[i - 1].pixels.size(), shapes[i].pixels.size());
        }
        for (const auto pixel : shapes[i].pixels)
            EXPECT_EQ(++owners[pixel], 1);
    }
}

TEST(Shapes, ABoxIsThreePlanesAtRightAngles) {
    ShapeRoom room(5);
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    room.solids = {
        test::box({0.0, 0.0, 1.2}, turn, {0.12, 0.10, 0.11}), test::wall({0, 0, 2.4}, {0, 0, -1})};
    auto detector = detector_for(room.camera);
    const auto shapes = detector.detect(room.frame().depth);
    ASSERT_GE(shapes.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
        ASSERT_EQ(shapes[i].fit.shape.kind, ShapeKind::plane) << i;
    for (std::size_t i = 1; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j)
            EXPECT_LT(std::abs(shapes[i].fit.shape.axis.dot(shapes[j].fit.shape.axis)), 0.01);
}

/// Things on a table with the noise of a Kinect, whole millimetres included.
ShapeRoom table_with(unsigned seed, bool boxes) {
    ShapeRoom room(seed);
    room.camera.depth_unit_m = 0.001;
    const Eigen::Vector3d up = Eigen::Vector3d(0.0, -0.8, -0.6).normalized();
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), back = up.cross(x), foot(0.0, 0.2, 1.1);
    room.solids = {test::wall(foot, up)};
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part;
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d place = foot + (0.28 * (i - 1)) * x + 0.1 * part(random) * back;
        if (boxes) {
            const Eigen::Vector3d half(
                0.03 + 0.06 * part(random), 0.03 + 0.06 * part(random), 0.03 + 0.09 * part(random)
            );
            Eigen::Matrix3d frame;
            frame << x, back, up;
            const Eigen::AngleAxisd turn(3.0 * part(random), up);
            room.solids.push_back(test::box(place + half.z() * up, turn * frame, half));
        } else {
            const double radius = 0.03 + 0.06 * part(random), height = 0.08 + 0.15 * part(random);
            room.solids.push_back(test::can(place, up, radius, height));
        }
    }
    return room;
}

TEST(Shapes, OnlyBoxesAreOnlyPlanes) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        ShapeRoom room = table_with(seed, true);
        auto detector = detector_for(room.camera);
        for (const auto& shape : detector.detect(room.frame().depth))
            EXPECT_EQ(shape.fit.shape.kind, ShapeKind::plane) << "seed " << seed;
    }
}

TEST(Shapes, OnlyCansAreCylindersAndTheirLids) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        ShapeRoom room = table_with(seed, false);
        auto detector = detector_for(room.camera);
        int cylinders = 0;
        for (const auto& shape : detector.detect(room.frame().depth)) {
            const ShapeKind kind = shape.fit.shape.kind;
            EXPECT_TRUE(kind == ShapeKind::plane || kind == ShapeKind::cylinder) << "seed " << seed;
            cylinders += kind == ShapeKind::cylinder ? 1 : 0;
        }
        EXPECT_EQ(cylinders, 3) << "seed " << seed;
    }
}

TEST(Shapes, ABallHalfHiddenIsABall) {
    ShapeRoom room(7);
    room.solids = {
        test::wall({0, 0, 2.4}, {0, 0, -1}),
        test::ball({0.2, 0.05, 1.0}, 0.08),
        test::box({0.22, 0.05, 0.8}, Eigen::Matrix3d::Identity(), {0.06, 0.1, 0.02})};
    auto detector = detector_for(room.camera);
    int balls = 0;
    for (const auto& shape : detector.detect(room.frame().depth))
        balls += shape.fit.shape.kind == ShapeKind::sphere ? 1 : 0;
    EXPECT_EQ(balls, 1);
}

TEST(Shapes, TheSamePictureGivesTheSameShapes) {
    ShapeRoom room(5);
    room.solids = {test::ball({0.1, 0.0, 1.1}, 0.07), test::wall({0, 0, 2.4}, {0, 0.2, -1})};
    const RgbdFrame frame = room.frame();
    auto one = detector_for(room.camera), other = detector_for(room.camera);
    (void)one.detect(frame.depth);
    const auto again = one.detect(frame.depth), first = other.detect(frame.depth);
    ASSERT_EQ(again.size(), first.size());
    for (std::size_t i = 0; i < again.size(); ++i)
        EXPECT_EQ(again[i].pixels, first[i].pixels);
}

TEST(Shapes, NothingToSeeIsNothingFound) {
    RgbdCamera camera;
    auto detector = detector_for(camera);
    EXPECT_TRUE(detector.detect({}).empty());
    std::vector<std::uint16_t> depth(100, 1000);
    EXPECT_TRUE(detector.detect(depth).empty());  // another size
    depth.assign(640 * 480, 0);
    EXPECT_TRUE(detector.detect(depth).empty());
    depth[240 * 640 + 320] = 1000;
    EXPECT_TRUE(detector.detect(depth).empty());  // one point
    for (std::size_t u = 0; u < 640; ++u)
        depth[240 * 640 + u] = 1000;
    EXPECT_TRUE(detector.detect(depth).empty());  // points on a line
    std::mt19937 random(3);
    for (auto& d : depth)
        d = static_cast<std::uint16_t>(random());
    EXPECT_TRUE(detector.detect(depth).empty());  // noise without a surface
    depth.assign(depth.size(), 1000);
    EXPECT_EQ(detector.detect(depth).size(), 1U);
}

TEST(Shapes, RefusesSettingsThatAreNone) {
    const auto refusal = [](const ShapesSettings& settings) {
        const auto detector = ShapeDetector::create(RgbdCamera{}, settings);
        return detector ? std::string() : detector.error().field;
    };
    const double nan = std::nan("");
    EXPECT_EQ(refusal({.kinds = {false, false, false, false}}), "kinds");
    for (const double radius : {0.0, -1.0, nan})
        EXPECT_EQ(refusal({.min_radius_m = radius}), "min_radius_m");
    for (const double radius : {0.005, -1.0, 3.0, nan})
        EXPECT_EQ(refusal({.max_radius_m = radius}), "max_radius_m");
    EXPECT_EQ(refusal({.min_points = 0}), "min_points");
    EXPECT_EQ(refusal({.max_shapes = 0}), "max_shapes");
    for (const double p : {0.0, 1.0, nan})
        EXPECT_EQ(refusal({.miss_probability = p}), "miss_probability");
}

}  // namespace
}  // namespace kinectlab
