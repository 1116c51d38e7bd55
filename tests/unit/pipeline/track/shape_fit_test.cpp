#include "pipeline/track/shape_fit.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/shape_room.hpp"

namespace kinectlab {
namespace {

using test::ShapeRoom;
using test::Solid;

struct Scatter {
    int frames = 0;
    double shift2 = 0.0, claimed_shift2 = 0.0;  // of what the surface shows of the place, m²
    double turn2 = 0.0, claimed_turn2 = 0.0;    // of the axis, rad²
    double size2 = 0.0, claimed_size2 = 0.0;
    double worst_m = 0.0;
};

/// The part of the place that the surface shows.
Eigen::Matrix3d shown(const Shape& shape) {
    const Eigen::Matrix3d along = shape.axis * shape.axis.transpose();
    if (shape.kind == ShapeKind::plane) return along;
    if (shape.kind == ShapeKind::cylinder) return Eigen::Matrix3d::Identity() - along;
    return Eigen::Matrix3d::Identity();
}

Scatter scatter_of(ShapeRoom& room, const Shape& truth, const Shape& guess, int frames) {
    ShapeFitter fitter(room.camera);
    DisparityImage image(room.camera);
    Scatter scatter;
    std::vector<std::uint32_t> pixels;
    for (int i = 0; i < frames; ++i) {
        image.load(room.frame().depth);
        if (pixels.empty()) pixels = room.pixels_of(0);
        const auto fit = fitter.fit(image, pixels, guess, false);
        if (!fit) continue;
        ++scatter.frames;
        const Eigen::Matrix3d P = shown(truth);
        const Eigen::Vector3d off = P * (fit->shape.point - truth.point);
        // A cylinder's place is its middle: compare the axes there.
        Eigen::Vector3d error = off;
        if (truth.kind == ShapeKind::cylinder) {
            const double h = height_on(truth, fit->shape.point);
            error = fit->shape.point - (truth.point + h * truth.axis);
        }
        if (truth.kind == ShapeKind::plane)
            error = truth.axis * truth.axis.dot(fit->shape.point - truth.point);
        scatter.shift2 += error.squaredNorm();
        scatter.worst_m = std::max(scatter.worst_m, error.norm());
        scatter.claimed_shift2 += (P * fit->covariance.topLeftCorner<3, 3>() * P).trace();
        if (truth.kind != ShapeKind::sphere) {
            scatter.turn2 += fit->shape.axis.cross(truth.axis).squaredNorm();
            // About the fitted axis, not the true one: about it the variance is a whole circle's.
            const Eigen::Vector3d& axis = fit->shape.axis;
            const Eigen::Matrix3d Q = Eigen::Matrix3d::Identity() - axis * axis.transpose();
            scatter.claimed_turn2 += (Q * fit->covariance.bottomRightCorner<3, 3>() * Q).trace();
        }
        scatter.size2 += std::pow(fit->shape.size - truth.size, 2);
        scatter.claimed_size2 += fit->size_u * fit->size_u;
    }
    return scatter;
}

void expect_honest(const Scatter& scatter, int frames) {
    ASSERT_EQ(scatter.frames, frames);
    EXPECT_GT(scatter.shift2 / scatter.claimed_shift2, 0.5);
    EXPECT_LT(scatter.shift2 / scatter.claimed_shift2, 1.6);
    if (scatter.claimed_turn2 > 0.0) {
        EXPECT_GT(scatter.turn2 / scatter.claimed_turn2, 0.5);
        EXPECT_LT(scatter.turn2 / scatter.claimed_turn2, 1.6);
    }
    if (scatter.claimed_size2 > 0.0) {
        EXPECT_GT(scatter.size2 / scatter.claimed_size2, 0.4);
        EXPECT_LT(scatter.size2 / scatter.claimed_size2, 2.0);
    }
}

constexpr int kFrames = 40;

TEST(ShapeFit, CylinderClaimsWhatItScatters) {
    ShapeRoom room(3);
    const Eigen::Vector3d axis = Eigen::Vector3d(0.15, -1.0, -0.4).normalized();
    room.solids = {
        test::can({0.05, 0.12, 1.1}, axis, 0.04, 0.16), test::wall({0, 0, 2.5}, {0, 0, -1})};
    const Shape truth{ShapeKind::cylinder, room.solids[0].place, axis, 0.04};
    const Shape guess{
        ShapeKind::cylinder,
        truth.point + Eigen::Vector3d(0.006, 0.0, 0.01),
        (axis + Eigen::Vector3d(0.1, 0.0, 0.05)).normalized(),
        0.045};
    expect_honest(scatter_of(room, truth, guess, kFrames), kFrames);
}

TEST(ShapeFit, ConeClaimsWhatItScatters) {
    ShapeRoom room(4);
    const Eigen::Vector3d axis = Eigen::Vector3d(0.1, 1.0, 0.3).normalized();
    room.solids = {
        test::cone({0.0, -0.1, 1.1}, axis, 0.35, 0.03, 0.22), test::wall({0, 0, 2.5}, {0, 0, -1})};
    const Shape truth{ShapeKind::cone, room.solids[0].place, axis, 0.35};
    const Shape guess{
        ShapeKind::cone,
        truth.point + Eigen::Vector3d(0.004, 0.01, 0.006),
        (axis + Eigen::Vector3d(0.06, 0.0, 0.05)).normalized(),
        0.40};
    expect_honest(scatter_of(room, truth, guess, kFrames), kFrames);
}

TEST(ShapeFit, PlaneClaimsWhatItScatters) {
    ShapeRoom room(5);
    const Eigen::Vector3d normal = Eigen::Vector3d(0.1, -0.8, -0.6).normalized();
    Eigen::Matrix3d turn;
    turn.col(2) = normal;
    turn.col(0) = normal.unitOrthogonal();
    turn.col(1) = normal.cross(turn.col(0));
    room.solids = {test::box({0.02, 0.05, 1.2}, turn, {0.1, 0.08, 0.0001})};
    const Shape truth{ShapeKind::plane, room.solids[0].place + 0.0001 * normal, normal, 0.0};
    const Shape guess{
        ShapeKind::plane,
        truth.point + Eigen::Vector3d(0.0, 0.0, 0.01),
        (normal + Eigen::Vector3d(0.1, 0.1, 0.0)).normalized(),
        0.0};
    expect_honest(scatter_of(room, truth, guess, kFrames), kFrames);
}

TEST(ShapeFit, SphereClaimsWhatItScatters) {
    ShapeRoom room(6);
    room.solids = {test::ball({0.1, 0.05, 1.4}, 0.06)};
    const Shape truth{ShapeKind::sphere, room.solids[0].place, Eigen::Vector3d::UnitY(), 0.06};
    const Shape guess{
        ShapeKind::sphere, truth.point + Eigen::Vector3d(0.005, 0.01, 0.02), truth.axis, 0.07};
    expect_honest(scatter_of(room, truth, guess, kFrames), kFrames);
}

TEST(ShapeFit, NothingThatDeterminesNoShapeIsFitted) {
    RgbdCamera camera;
    ShapeFitter fitter(camera);
    DisparityImage image(camera);
    std::vector<std::uint16_t> depth(640 * 480, 0);
    std::vector<std::uint32_t> all(depth.size());
    for (std::uint32_t i = 0; i < all.size(); ++i)
        all[i] = i;
    const auto refused = [&](std::span<const std::uint32_t> pixels) {
        image.load(depth);
        for (const auto kind :
             {ShapeKind::plane, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone}) {
            Shape guess{kind, {0, 0, 1}, {0, 0, -1}, kind == ShapeKind::cone ? 0.3 : 0.05};
            EXPECT_FALSE(fitter.fit(image, pixels, guess, false)) << name_of(kind);
            guess.point.x() = std::nan("");
            EXPECT_FALSE(fitter.fit(image, pixels, guess, false)) << name_of(kind);
        }
    };
    refused({});
    refused(all);  // no readings at all
    depth[240 * 640 + 320] = 1000;
    refused(all);  // one point
    for (std::size_t u = 200; u < 400; ++u)
        depth[240 * 640 + u] = 1000;
    refused(all);  // points on a line
}

}  // namespace
}  // namespace kinectlab
