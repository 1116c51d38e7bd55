#include "pipeline/track/shape_sample.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "pipeline/track/shape_support.hpp"

namespace kinectlab {
namespace {

double between(double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 10001) / 10000.0;
}

Eigen::Vector3d direction() {
    const double z = between(-1.0, 1.0), angle = between(0.0, 6.28), across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
}

/// A point of a round shape at an angle about its axis, by its generating curve.
OrientedPoint on(const Shape& shape, double angle, double along) {
    const Eigen::Vector3d e1 = shape.axis.unitOrthogonal(), e2 = shape.axis.cross(e1);
    const Eigen::Vector3d side = std::cos(angle) * e1 + std::sin(angle) * e2;
    switch (shape.kind) {
        case ShapeKind::sphere: {
            const Eigen::Vector3d n =
                (std::cos(along) * side + std::sin(along) * shape.axis).normalized();
            return {shape.point + shape.size * n, n, 0.0};
        }
        case ShapeKind::cylinder:
            return {shape.point + along * shape.axis + shape.size * side, side, 0.0};
        default:
            return {
                shape.point + along * (shape.axis + std::tan(shape.size) * side),
                std::cos(shape.size) * side - std::sin(shape.size) * shape.axis,
                0.0};
    }
}

RC_GTEST_PROP(ShapeSample, ExactPointsGiveTheShapeBack, ()) {
    Shape truth;
    truth.kind = *rc::gen::element(ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone);
    truth.point = {between(-1, 1), between(-1, 1), between(1, 3)};
    truth.axis = direction();
    truth.size = truth.kind == ShapeKind::cone ? between(0.2, 1.0) : between(0.02, 0.5);
    const double turn = between(0.0, 6.28);
    const OrientedPoint sample[3] = {
        on(truth, turn, 0.1),
        on(truth, turn + between(0.6, 1.2), 0.3),
        on(truth, turn - between(0.6, 1.2), 0.2)};
    const auto found = through_sample(truth.kind, sample);
    RC_ASSERT(found.has_value());
    RC_ASSERT(std::abs(found->size - truth.size) < 1e-6);
    if (truth.kind == ShapeKind::cylinder) {
        RC_ASSERT(found->axis.cross(truth.axis).norm() < 1e-6);
        RC_ASSERT((found->point - truth.point).cross(truth.axis).norm() < 1e-6);
    } else {
        RC_ASSERT((found->point - truth.point).norm() < 1e-6);
    }
    if (truth.kind == ShapeKind::cone) RC_ASSERT(found->axis.dot(truth.axis) > 1.0 - 1e-9);
}

TEST(ShapeSample, APlaneFacesTheCamera) {
    const OrientedPoint sample[3] = {
        {{0, 0, 1}, {0, 0, -1}}, {{0.1, 0, 1}, {0, 0, -1}}, {{0, 0.1, 1}, {0, 0, -1}}};
    const auto found = through_sample(ShapeKind::plane, sample);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->axis.z(), -1.0, 1e-12);
}

TEST(ShapeSample, SamplesThatDetermineNothing) {
    const Eigen::Vector3d n(0, 0, -1);
    const OrientedPoint line[3] = {{{0, 0, 1}, n}, {{0.1, 0, 1}, n}, {{0.2, 0, 1}, n}};
    const OrientedPoint same[3] = {{{0, 0, 1}, n}, {{0, 0, 1}, n}, {{0, 0, 1}, n}};
    const double nan = std::nan("");
    const OrientedPoint none[3] = {
        {{nan, 0, 1}, n}, {{0.1, nan, 1}, {1, 0, 0}}, {{0.2, 0.1, 1}, {0, nan, 0}}};
    for (const auto kind :
         {ShapeKind::plane, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone}) {
        EXPECT_FALSE(through_sample(kind, line)) << name_of(kind);
        EXPECT_FALSE(through_sample(kind, same)) << name_of(kind);
        EXPECT_FALSE(through_sample(kind, none)) << name_of(kind);
        EXPECT_FALSE(through_sample(kind, {})) << name_of(kind);
    }
}

TEST(ShapeSupport, ExtrapolatesWithinItsBounds) {
    const SupportBounds half = extrapolate(64, 128, 10000);
    EXPECT_LT(half.low, 5000.0);
    EXPECT_GT(half.high, 5000.0);
    EXPECT_NEAR(half.middle, 5000.0, 150.0);
    const SupportBounds all = extrapolate(700, 1000, 1000);
    EXPECT_EQ(all.low, 700.0);
    EXPECT_EQ(all.high, 700.0);
    const SupportBounds none = extrapolate(0, 0, 0);
    EXPECT_EQ(none.high, 0.0);
}

}  // namespace
}  // namespace kinectlab
