// Each apparatus against the closed forms of textbooks.
#include <cmath>
#include <numbers>

#include "tests/unit/pipeline/simulate/apparatus_support.hpp"

namespace kinectlab::simulate {
namespace {

constexpr double kG = 9.81;
constexpr double kDegree = std::numbers::pi / 180.0;

TEST(Projectile, FliesAParabolaWithoutAir) {
    auto flight = released(
        "projectile", {{"speed_m_s", 2.0}, {"elevation_deg", 40.0}, {"air_density_kg_m3", 0.0}}
    );
    const Eigen::Vector3d from = flight->bodies().front().p_lab;
    for (const double t : {0.01, 0.2, 0.45}) {
        const Body ball = after(*flight, t);
        const Eigen::Vector3d v(
            2.0 * std::cos(40.0 * kDegree), 0.0, 2.0 * std::sin(40.0 * kDegree)
        );
        const Eigen::Vector3d fall(0.0, 0.0, -kG);
        EXPECT_LT((ball.p_lab - from - t * v - 0.5 * t * t * fall).norm(), 1e-12);
        EXPECT_LT((ball.v_lab - v - t * fall).norm(), 1e-12);
    }
}

TEST(Projectile, FallsThroughAirAsTheHyperbolicCosineSays) {
    auto flight = released(
        "projectile",
        {{"speed_m_s", 0.0},
         {"ball_density_kg_m3", 30.0},
         {"air_density_kg_m3", 1.2},
         {"drag_coefficient", 0.5},
         {"ball_radius_m", 0.03}}
    );
    const double from = flight->bodies().front().p_lab.z();
    const double air = 1.2 / 30.0;  // over the ball's density: it lifts, and half of it moves along
    const double pull = kG * (1.0 - air) / (1.0 + air / 2.0);
    const double drag = 0.375 * 0.5 * air / 0.03 / (1.0 + air / 2.0);
    const double t = 0.35;
    EXPECT_NEAR(
        from - after(*flight, t).p_lab.z(),
        std::log(std::cosh(std::sqrt(pull * drag) * t)) / drag,
        1e-11
    );
}

TEST(Projectile, RestsOnTheTrayWhereTheParabolaMeetsIt) {
    const ParameterMap given{
        {"speed_m_s", 2.0}, {"elevation_deg", 0.0}, {"air_density_kg_m3", 0.0}};
    auto seldom = released("projectile", given);
    const Eigen::Vector3d from = seldom->bodies().front().p_lab;
    const Body ball = after(*seldom, 5.0);
    EXPECT_NEAR(ball.p_lab.z(), 0.52 + 0.03, 1e-9);
    EXPECT_NEAR(ball.p_lab.x(), from.x() + 2.0 * std::sqrt(2.0 * (from.z() - 0.55) / kG), 1e-9);
    EXPECT_EQ(ball.v_lab.norm(), 0.0);
    EXPECT_EQ(seldom->motion(), Motion::free);
    auto often = released("projectile", given);
    for (double t = 0.0; t < 5.0; t += 0.0137)
        (void)after(*often, t);
    EXPECT_LT((after(*often, 5.0).p_lab - ball.p_lab).norm(), 1e-10);
}

TEST(Incline, RollsWithFiveSeventhsOfThePull) {
    auto plank = released("incline", {{"incline_deg", 10.0}});
    const Eigen::Vector3d from = plank->bodies().front().p_lab;
    const Body ball = after(*plank, 0.9);
    const double a = 5.0 / 7.0 * kG * std::sin(10.0 * kDegree);
    EXPECT_NEAR((ball.p_lab - from).norm(), 0.5 * a * 0.81, 1e-12);
    EXPECT_NEAR(
        std::atan2(from.z() - ball.p_lab.z(), ball.p_lab.x() - from.x()), 10.0 * kDegree, 1e-12
    );
    // Where it touches, the ball stands still.
    const Eigen::Vector3d to_plank(-std::sin(10.0 * kDegree), 0.0, -std::cos(10.0 * kDegree));
    EXPECT_LT((ball.v_lab + ball.w_lab.cross(0.035 * to_plank)).norm(), 1e-12);
}

TEST(Incline, SlidesWhereFrictionDoesNotSuffice) {
    const double enough = 2.0 / 7.0 * std::tan(20.0 * kDegree);
    auto grips = released("incline", {{"incline_deg", 20.0}, {"friction", 1.01 * enough}});
    EXPECT_NEAR(after(*grips, 0.5).w_lab.y() * 0.035, after(*grips, 0.5).v_lab.norm(), 1e-12);
    auto slides = released("incline", {{"incline_deg", 20.0}, {"friction", 0.05}});
    const Body ball = after(*slides, 0.5);
    const double cosine = std::cos(20.0 * kDegree);
    EXPECT_NEAR(ball.v_lab.norm(), 0.5 * kG * (std::sin(20.0 * kDegree) - 0.05 * cosine), 1e-12);
    EXPECT_NEAR(ball.w_lab.y() * 0.035, 0.5 * 2.5 * 0.05 * kG * cosine, 1e-12);
}

TEST(Incline, DragSlowsAndHoldsTheBall) {
    auto rolls = released("incline", {{"incline_deg", 8.0}, {"rolling_drag", 0.05}});
    const double a = 5.0 / 7.0 * kG * (std::sin(8.0 * kDegree) - 0.05 * std::cos(8.0 * kDegree));
    EXPECT_NEAR(after(*rolls, 0.5).v_lab.norm(), 0.5 * a, 1e-12);
    auto stays = released("incline", {{"incline_deg", 2.0}, {"rolling_drag", 0.1}});
    EXPECT_EQ(after(*stays, 9.0).v_lab.norm(), 0.0);
    EXPECT_EQ(after(*rolls, 9.0).v_lab.norm(), 0.0) << "caught by the stop";
}

TEST(Spring, SwingsAsTheDampedOscillatorDoes) {
    const double damping = 0.3;
    const double own = std::sqrt(40.0 - damping * damping);
    auto spring = released(
        "spring", {{"stiffness_n_m", 10.0}, {"mass_kg", 0.25}, {"damping_per_s", damping}}, 0.12
    );
    EXPECT_NEAR(spring->value(), 0.12, 1e-12);
    for (const double t : {0.1, 1.0, 7.7}) {
        const double y = -0.12 * std::exp(-damping * t) *
                         (std::cos(own * t) + damping / own * std::sin(own * t));
        EXPECT_NEAR(after(*spring, t).p_lab.z() - 1.10, y, 1e-9) << t;
    }
}

TEST(Spring, AnswersADriveWithItsResonanceCurve) {
    const double damping = 0.4, hz = 0.9, rate_2 = 40.0;
    auto spring = released(
        "spring",
        {{"stiffness_n_m", 10.0},
         {"mass_kg", 0.25},
         {"damping_per_s", damping},
         {"drive_hz", hz},
         {"drive_amplitude_m", 0.02}}
    );
    const double w = 2.0 * std::numbers::pi * hz;
    const double expected = 0.02 * rate_2 / std::hypot(rate_2 - w * w, 2.0 * damping * w);
    const double late = after(*spring, 60.0).p_lab.z() - 1.10;
    const double quarter = after(*spring, 60.0 + 0.25 / hz).p_lab.z() - 1.10;
    EXPECT_NEAR(std::hypot(late, quarter), expected, 1e-7);
    const auto shaken = make_apparatus(
        {"spring",
         {{"drive_hz", std::sqrt(rate_2) / (2.0 * std::numbers::pi)}, {"drive_amplitude_m", 0.05}}}
    );
    ASSERT_FALSE(shaken);
    EXPECT_EQ(shaken.error().field, "drive_amplitude_m");
}

TEST(Collision, KeepsMomentumAndLosesWhatRestitutionSays) {
    for (const double offset : {0.0, 0.05}) {
        auto table = released(
            "collision",
            {{"mass_a_kg", 0.4}, {"mass_b_kg", 0.15}, {"restitution", 0.7}, {"offset_m", offset}}
        );
        const Eigen::Vector3d before = after(*table, 0.2).v_lab;
        const Body a = after(*table, 1.5, 0);
        const Body b = after(*table, 1.5, 1);
        EXPECT_LT((0.4 * before - 0.4 * a.v_lab - 0.15 * b.v_lab).norm(), 1e-12);
        const double sine = offset / 0.085;
        const Eigen::Vector3d n(std::sqrt(1.0 - sine * sine), sine, 0.0);
        EXPECT_NEAR((b.v_lab - a.v_lab).dot(n), 0.7 * before.dot(n), 1e-12);
        EXPECT_NEAR(b.v_lab.cross(n).norm(), 0.0, 1e-12) << "smooth balls push along n only";
        EXPECT_GT(b.v_lab.x(), 0.3);
        // Never nearer than touching.
        auto again = released("collision", {{"offset_m", offset}});
        for (double t = 0.0; t < 3.0; t += 0.01)
            EXPECT_GT((after(*again, t).p_lab - after(*again, t, 1).p_lab).norm(), 0.085 - 1e-9);
    }
}

TEST(Robot, DrivesWhereItHeads) {
    auto robot = released("robot");
    const Eigen::Vector3d start = robot->bodies().front().p_lab;
    const double h = 1e-5;
    for (double t = 0.013; t < 30.0; t += 0.37) {
        const Body now = after(*robot, t);
        const Body next = after(*robot, t + h);
        const Eigen::Vector3d ahead = now.q_lab_body * Eigen::Vector3d::UnitX();
        EXPECT_LT(now.v_lab.cross(ahead).norm(), 1e-12) << "it cannot drive sideways";
        EXPECT_LT((next.p_lab - now.p_lab - h * now.v_lab).norm(), 1e-8) << t;
        EXPECT_LT(std::abs(now.p_lab.x()) + 0.1, 0.6);
        EXPECT_LT(std::abs(now.p_lab.y()) + 0.1, 0.4);
    }
    const double round = 1.0 / 0.15 + 6.0 + 2.0 * 0.14 / 0.15;
    EXPECT_LT((after(*robot, 3.0 * round).p_lab - start).norm(), 1e-9) << "the course is closed";
}

TEST(Tumbler, KeepsItsAngularMomentumAndEnergy) {
    auto box = released(
        "tumbler", {{"rate_x_deg_s", 20.0}, {"rate_y_deg_s", 150.0}, {"rate_z_deg_s", 5.0}}
    );
    const Eigen::Vector3d squares = Eigen::Vector3d(0.20, 0.14, 0.08).cwiseAbs2();
    const Eigen::Vector3d inertia = Eigen::Vector3d::Constant(squares.sum()) - squares;
    const auto momentum = [&](const Body& b) -> Eigen::Vector3d {
        return b.q_lab_body * inertia.cwiseProduct(b.q_lab_body.conjugate() * b.w_lab);
    };
    const Body first = after(*box, 0.01);
    const double h = 1e-5;
    double least_y = 1e9;
    for (double t = 0.5; t < 40.0; t += 0.5) {
        const Body now = after(*box, t);
        EXPECT_LT((momentum(now) - momentum(first)).norm(), 1e-9 * momentum(first).norm());
        EXPECT_NEAR(now.w_lab.dot(momentum(now)), first.w_lab.dot(momentum(first)), 1e-10);
        const Eigen::AngleAxisd turn(after(*box, t + h).q_lab_body * now.q_lab_body.conjugate());
        EXPECT_LT((turn.angle() / h * turn.axis() - now.w_lab).norm(), 1e-4);
        EXPECT_EQ(now.p_lab, first.p_lab);
        least_y = std::min(least_y, (now.q_lab_body.conjugate() * now.w_lab).y());
    }
    EXPECT_LT(least_y, -2.0) << "about its middle axis it turns over";
}

}  // namespace
}  // namespace kinectlab::simulate
