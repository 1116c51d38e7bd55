#include "pipeline/motion/motion.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "pipeline/motion/local_polynomial.hpp"

namespace kinectlab {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

/// A bob on a slow sine along the camera's x, turning steadily about its own z.
TrackSample sample_at(double t_s, double turn_rad_s = 0.0) {
    TrackSample sample;
    sample.t = from_seconds(t_s) + 1'700'000'000 * kNsPerSecond;
    sample.status = TrackStatus::tracked;
    sample.p_cam = {0.2 * std::sin(3.0 * t_s), 0.1, 1.6};
    sample.covariance.diagonal() << 1e-8, 1e-8, 4e-8, 1e-6, 1e-6, 1e-6;
    sample.has_orientation = turn_rad_s != 0.0;
    sample.q_cam_obj = Eigen::AngleAxisd(turn_rad_s * t_s, Eigen::Vector3d::UnitZ());
    return sample;
}

std::vector<TrackSample> swing(int frames, double turn_rad_s = 0.0) {
    std::vector<TrackSample> samples;
    for (int i = 0; i < frames; ++i)
        samples.push_back(sample_at(i * kFrame_s, turn_rad_s));
    return samples;
}

double seconds_of(const MotionSample& sample) {
    return to_seconds(sample.t - 1'700'000'000 * kNsPerSecond);
}

Trajectory motion_of(std::span<const TrackSample> samples) {
    return to_trajectory("bob", samples, Eigen::Isometry3d::Identity());
}

TEST(Motion, VelocityAndAccelerationOfASlowSwing) {
    for (const auto& sample : motion_of(swing(60)).samples) {
        const double t = seconds_of(sample);
        EXPECT_NEAR(sample.v_lab.x(), 0.6 * std::cos(3.0 * t), 0.01) << t;
        const bool at_an_end = t < 0.14 || t > 59 * kFrame_s - 0.14;
        EXPECT_NEAR(sample.a_lab.x(), -1.8 * std::sin(3.0 * t), at_an_end ? 0.4 : 0.03) << t;
        EXPECT_NEAR(sample.v_lab.y(), 0.0, 1e-9);
    }
}

TEST(Motion, UnevenTimesMakeNoDifference) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> jitter(-0.01, 0.01);
    std::vector<TrackSample> samples;
    for (int i = 0; i < 90; ++i)
        samples.push_back(sample_at(i * kFrame_s + jitter(random)));
    for (const auto& sample : motion_of(samples).samples)
        EXPECT_NEAR(sample.v_lab.x(), 0.6 * std::cos(3.0 * seconds_of(sample)), 0.015);
}

TEST(Motion, ShortGapsAreFilledAndMarked) {
    auto samples = swing(60);
    for (int i = 20; i < 25; ++i)
        samples[static_cast<std::size_t>(i)].status = TrackStatus::lost;
    const auto filled = motion_of(samples).samples;
    ASSERT_EQ(filled.size(), 60U);
    for (int i = 18; i < 27; ++i) {
        const auto& sample = filled[static_cast<std::size_t>(i)];
        const bool inside = i >= 20 && i < 25;
        EXPECT_EQ(sample.status, inside ? TrackStatus::interpolated : TrackStatus::tracked) << i;
        EXPECT_NEAR(sample.p_lab.x(), 0.2 * std::sin(3.0 * seconds_of(sample)), 5e-4) << i;
        EXPECT_NEAR(sample.v_lab.x(), 0.6 * std::cos(3.0 * seconds_of(sample)), 0.02) << i;
        EXPECT_TRUE(sample.covariance.allFinite());
    }
    EXPECT_GE(filled[22].sigma_p().x(), filled[19].sigma_p().x());
}

TEST(Motion, LongGapsStayLostAndNothingReachesAcrossThem) {
    auto samples = swing(60);
    for (int i = 20; i < 30; ++i)
        samples[static_cast<std::size_t>(i)].status = TrackStatus::lost;
    for (int i = 30; i < 60; ++i)
        samples[static_cast<std::size_t>(i)].p_cam.y() += 1.0;
    const auto motion = motion_of(samples).samples;
    for (int i = 20; i < 30; ++i) {
        EXPECT_EQ(motion[static_cast<std::size_t>(i)].status, TrackStatus::lost);
        EXPECT_TRUE(motion[static_cast<std::size_t>(i)].p_lab.array().isNaN().all());
        EXPECT_TRUE(motion[static_cast<std::size_t>(i)].v_lab.array().isNaN().all());
    }
    EXPECT_NEAR(motion[19].v_lab.y(), 0.0, 1e-9);
    EXPECT_NEAR(motion[30].v_lab.y(), 0.0, 1e-9);
}

TEST(Motion, LostAtTheEndsStaysLost) {
    auto samples = swing(20);
    samples.front().status = samples.back().status = TrackStatus::lost;
    const auto motion = motion_of(samples).samples;
    EXPECT_EQ(motion.front().status, TrackStatus::lost);
    EXPECT_EQ(motion.back().status, TrackStatus::lost);
}

TEST(Motion, LostFramesAreNotInventedButDerivativesKnowOfThem) {
    auto samples = swing(60);
    samples.erase(samples.begin() + 30, samples.begin() + 33);
    const auto motion = motion_of(samples).samples;
    ASSERT_EQ(motion.size(), 57U);
    EXPECT_NEAR(motion[30].v_lab.x(), 0.6 * std::cos(3.0 * seconds_of(motion[30])), 0.01);
}

TEST(Motion, AngularVelocityHasNoJumps) {
    // Ten turns a second would be ambiguous; two are not, and pass every sign of the quaternion.
    for (const double turn : {-12.0, 0.5, 12.0})
        for (const auto& sample : motion_of(swing(90, turn)).samples) {
            EXPECT_NEAR(sample.w_lab.z(), turn, 1e-6);
            EXPECT_NEAR(sample.w_lab.head<2>().norm(), 0.0, 1e-6);
        }
}

TEST(Motion, GoesIntoTheLabWithItsCovariance) {
    Eigen::Isometry3d T_lab_cam = Eigen::Isometry3d::Identity();
    T_lab_cam.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // z forward becomes y, y down becomes -z
    T_lab_cam.translation() << 1, 2, 3;
    const auto samples = swing(9);
    const auto lab = to_trajectory("bob", samples, T_lab_cam).samples[4];
    EXPECT_TRUE(lab.p_lab.isApprox(T_lab_cam * samples[4].p_cam));
    EXPECT_NEAR(lab.sigma_p().y(), 2e-4, 1e-12);
    EXPECT_NEAR(lab.sigma_p().z(), 1e-4, 1e-12);
}

TEST(Motion, UncertaintiesOfTheDerivativesAreTheirScatter) {
    constexpr int kSeeds = 150;
    constexpr std::size_t kMiddle = 10;
    double v = 0.0, a = 0.0, w = 0.0;
    MotionSample told;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        auto samples = swing(21, 0.5);
        for (auto& s : samples) {
            s.p_cam.z() += 2e-4 * normal(random);
            s.q_cam_obj =
                Eigen::AngleAxisd(1e-3 * normal(random), Eigen::Vector3d::UnitX()) * s.q_cam_obj;
        }
        told = motion_of(samples).samples[kMiddle];
        v += told.v_lab.z() * told.v_lab.z() / kSeeds;
        a += told.a_lab.z() * told.a_lab.z() / kSeeds;
        w += told.w_lab.x() * told.w_lab.x() / kSeeds;
    }
    EXPECT_NEAR(told.sigma_v.z() / std::sqrt(v), 1.0, 0.2);
    EXPECT_NEAR(told.sigma_a.z() / std::sqrt(a), 1.0, 0.2);
    EXPECT_NEAR(told.sigma_w.x() / std::sqrt(w), 1.0, 0.2);
    EXPECT_NEAR(told.sigma_v.x(), told.sigma_v.z() / 2.0, 1e-9) << "x is known twice as well";
}

TEST(Motion, WithoutACovarianceTheUncertaintyIsNotKnown) {
    auto samples = swing(21);
    samples[9].covariance.setZero();
    EXPECT_TRUE(motion_of(samples).samples[10].sigma_v.array().isNaN().all());
    EXPECT_TRUE(motion_of(samples).samples[10].v_lab.allFinite());
}

TEST(Motion, RepeatedTimesAreDropped) {
    auto samples = swing(10);
    samples.insert(samples.begin() + 5, samples[4]);
    EXPECT_EQ(motion_of(samples).samples.size(), 10U);
}

TEST(Motion, FewSamplesGiveAPlaceButNoVelocity) {
    const auto motion = motion_of(swing(2)).samples;
    EXPECT_EQ(motion[0].status, TrackStatus::tracked);
    EXPECT_TRUE(motion[0].v_lab.array().isNaN().all());
}

RC_GTEST_PROP(LocalPolynomial, IsExactForCubicsAtAnyTimes, ()) {
    const auto c = *rc::gen::container<std::vector<int>>(4, rc::gen::inRange(-5, 6));
    const auto steps = *rc::gen::container<std::vector<int>>(12, rc::gen::inRange(5, 30));
    std::vector<TimedVector> samples;
    TimeNs t = 0;
    const auto cubic = [&](double s) {
        return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
    };
    for (const int step : steps) {
        t += step * 1'000'000;
        samples.push_back(
            {t, Eigen::Vector3d::Constant(cubic(to_seconds(t))), Eigen::Vector3d(1, 2, 3)}
        );
    }
    const TimeNs at = samples[6].t;
    const double s = to_seconds(at);
    const auto found = differentiate(samples, at, 0.5);
    RC_ASSERT(found.has_value());
    RC_ASSERT(std::abs(found->first.x() - (c[1] + 2 * c[2] * s + 3 * c[3] * s * s)) < 1e-6);
    RC_ASSERT(std::abs(found->second.z() - (2 * c[2] + 6 * c[3] * s)) < 1e-4);
}

TEST(LocalPolynomial, PassesItsBandwidthAtMinusThreeDecibels) {
    const double f = 5.0;
    std::vector<TimedVector> sine;
    for (int i = -500; i <= 500; ++i) {
        const double s = 0.001 * i;
        sine.push_back(
            {from_seconds(s),
             Eigen::Vector3d::Constant(std::sin(2 * M_PI * f * s)),
             Eigen::Vector3d::Ones()}
        );
    }
    const auto found = differentiate(sine, 0, half_window_s(f));
    EXPECT_NEAR(found->first.x() / (2 * M_PI * f), std::sqrt(0.5), 0.01);
}

}  // namespace
}  // namespace kinectlab
