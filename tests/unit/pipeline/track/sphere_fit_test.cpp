#include "pipeline/track/sphere_fit.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

using test::Ball;
using test::BallRoom;

double between(int low, int high) {
    return *rc::gen::inRange(low, high + 1) / 1000.0;
}

RC_GTEST_PROP(SphereFit, FindsANoiseFreeBallFromARoughGuess, ()) {
    BallRoom room;
    room.sigma_steps = 0.0;
    const Ball ball{{between(-300, 300), between(-200, 200), between(700, 2200)}, between(40, 90)};
    const RgbdFrame frame = room.frame({ball});
    Sphere guess{ball.centre_cam, ball.radius};
    for (int axis = 0; axis < 3; ++axis)
        guess.centre_cam[axis] += ball.radius * between(-200, 200);
    SphereFitter fitter(room.camera);
    const auto known = fitter.fit(frame.depth, guess, true);
    RC_ASSERT(known.has_value());
    // Readings are rounded to a millimetre, over hundreds of pixels.
    RC_ASSERT((known->sphere.centre_cam - ball.centre_cam).norm() < 2e-4);
    RC_ASSERT(known->quality.inlier_share > 0.99);
    guess.radius *= 1.15;
    const auto free = fitter.fit(frame.depth, guess, false);
    RC_ASSERT(free.has_value());
    RC_ASSERT((free->sphere.centre_cam - ball.centre_cam).norm() < 1e-3);
    RC_ASSERT(std::abs(free->sphere.radius - ball.radius) < 1e-3);
}

struct Scatter {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    Eigen::Vector3d claimed = Eigen::Vector3d::Zero();  // variances
    int frames = 0;
};

Scatter scatter_of(bool known_radius, double distance_m) {
    BallRoom room(5);
    SphereFitter fitter(room.camera);
    Scatter scatter;
    for (int i = 0; i < 60; ++i) {
        const Ball ball{{0.001 * i, 0.02, distance_m + 0.0005 * i}, 0.05};
        Sphere guess{ball.centre_cam + Eigen::Vector3d(0.004, 0.003, 0.008), ball.radius};
        const auto fit = fitter.fit(room.frame({ball}).depth, guess, known_radius);
        if (!fit) continue;
        const Eigen::Vector3d error = fit->sphere.centre_cam - ball.centre_cam;
        scatter.mean += error;
        scatter.squares += error.cwiseAbs2();
        scatter.claimed += fit->covariance.diagonal();
        ++scatter.frames;
    }
    return scatter;
}

TEST(SphereFit, ClaimsWhatItScatters) {
    for (const bool known : {true, false}) {
        const Scatter scatter = scatter_of(known, 1.6);
        ASSERT_EQ(scatter.frames, 60);
        // 180 squares: their mean scatters by a tenth.
        const double ratio = scatter.squares.cwiseQuotient(scatter.claimed).mean();
        EXPECT_GT(ratio, 0.6) << known;
        EXPECT_LT(ratio, 1.4) << known;
    }
}

TEST(SphereFit, IsNotPulledTowardsTheCamera) {
    const Scatter scatter = scatter_of(true, 1.6);
    const double scatter_of_mean = std::sqrt(scatter.squares.z()) / scatter.frames;
    EXPECT_LT(std::abs(scatter.mean.z() / scatter.frames), 3.5 * scatter_of_mean);
}

TEST(SphereFit, DoesNotMindAStringAndMissingPixels) {
    BallRoom room(9);
    room.string_above = true;
    room.missing_share = 0.1;
    const Ball ball{{0.1, 0.05, 1.6}, 0.05};
    SphereFitter fitter(room.camera);
    const auto fit = fitter.fit(room.frame({ball}).depth, {{0.105, 0.045, 1.61}, 0.05}, true);
    ASSERT_TRUE(fit);
    EXPECT_LT((fit->sphere.centre_cam - ball.centre_cam).norm(), 1e-3);
    EXPECT_NEAR(fit->visible_share, 0.9, 0.03);
    EXPECT_GT(fit->alone_share, 0.8);
}

TEST(SphereFit, NoisierThanPromisedIsClaimedAsSuch) {
    BallRoom room(3);
    SphereFitter fitter(room.camera);
    const Ball ball{{0.0, 0.0, 1.6}, 0.05};
    const auto promised = fitter.fit(room.frame({ball}).depth, {ball.centre_cam, 0.05}, true);
    room.sigma_steps *= 2.0;
    const auto noisier = fitter.fit(room.frame({ball}).depth, {ball.centre_cam, 0.05}, true);
    ASSERT_TRUE(promised && noisier);
    EXPECT_GT(noisier->covariance.trace(), 2.0 * promised->covariance.trace());
}

TEST(SphereFit, AWallIsNoSphere) {
    BallRoom room;
    SphereFitter fitter(room.camera);
    const auto fit = fitter.fit(room.frame({}).depth, {{0, 0, 3.25}, 0.05}, true);
    EXPECT_TRUE(!fit || fit->alone_share < 0.1);
}

}  // namespace
}  // namespace kinectlab
