#include "pipeline/track/rigid_fit.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

struct Case {
    Eigen::Isometry3d T;
    std::vector<PointPair> pairs;
};

/// `right` pairs with Gaussian noise, `wrong` ones anywhere.
Case made_case(unsigned seed, int right, int wrong, double sigma_m) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> place(-0.1, 0.1);
    const auto anywhere = [&] {
        return Eigen::Vector3d(place(random), place(random), place(random));
    };
    Case made;
    made.T = Eigen::Translation3d(0.1, 0.2, 1.2) * Eigen::AngleAxisd(0.8, anywhere().normalized());
    for (int i = 0; i < right + wrong; ++i) {
        PointPair pair;
        pair.p_obj = anywhere();
        pair.p_cam = i < right ? made.T * pair.p_obj : Eigen::Vector3d(made.T * anywhere());
        pair.p_cam += sigma_m * Eigen::Vector3d(normal(random), normal(random), normal(random));
        pair.covariance = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
        made.pairs.push_back(pair);
    }
    return made;
}

TEST(RigidFit, FindsTheTransformAmongTwiceAsManyWrongPairsAndKnowsHowWell) {
    double place = 0.0, turn = 0.0;
    constexpr int kCases = 40;
    for (unsigned seed = 1; seed <= kCases; ++seed) {
        const Case made = made_case(seed, 30, 60, 0.001);
        const auto fit = fit_rigid(made.pairs, {});
        ASSERT_TRUE(fit) << seed;
        EXPECT_GE(fit->inliers, 27) << seed;
        const Eigen::Vector3d off = fit->T_cam_obj.translation() - made.T.translation();
        const Eigen::AngleAxisd by(fit->T_cam_obj.linear() * made.T.linear().transpose());
        const Eigen::Vector3d turned = by.angle() * by.axis();
        const Matrix6d inverse = fit->covariance.inverse();
        place += off.dot(fit->covariance.topLeftCorner<3, 3>().inverse() * off) / 3.0;
        turn += turned.dot(fit->covariance.bottomRightCorner<3, 3>().inverse() * turned) / 3.0;
        EXPECT_TRUE(inverse.allFinite());
    }
    EXPECT_NEAR(place / kCases, 1.0, 0.5);
    EXPECT_NEAR(turn / kCases, 1.0, 0.5);
}

TEST(RigidFit, NothingWherePairsDoNotAgree) {
    EXPECT_FALSE(fit_rigid({}, {}));
    EXPECT_FALSE(fit_rigid(made_case(1, 2, 0, 0.001).pairs, {}));
    EXPECT_FALSE(fit_rigid(made_case(1, 0, 60, 0.0005).pairs, {}));
}

TEST(RigidFit, NothingForPointsOnALineOrInOnePlace) {
    Case made = made_case(3, 30, 0, 0.001);
    for (auto& pair : made.pairs) {
        pair.p_obj = Eigen::Vector3d(pair.p_obj.x(), 0.0, 0.0);
        pair.p_cam = made.T * pair.p_obj;
    }
    EXPECT_FALSE(fit_rigid(made.pairs, {}));
    for (auto& pair : made.pairs)
        pair.p_obj = pair.p_cam = Eigen::Vector3d::Ones();
    EXPECT_FALSE(fit_rigid(made.pairs, {}));
}

TEST(RigidFit, NothingForNumbersThatAreNone) {
    Case made = made_case(4, 30, 0, 0.001);
    for (auto& pair : made.pairs)
        pair.p_cam.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(fit_rigid(made.pairs, {}));
}

}  // namespace
}  // namespace kinectlab
