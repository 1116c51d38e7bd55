#include "server/experiments/trajectory_table.hpp"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/analysis/pendulum.hpp"

namespace kinectlab::experiments {
namespace {

constexpr double kG = 9.81;
constexpr double kLength = 0.8;  // m

/// A point pendulum in a plane, 30 Hz, 20 s, 15°, by Runge and Kutta's rule; 0.5 mm of noise.
struct Swing {
    std::vector<double> t, x, y;

    Swing() {
        std::mt19937 random(1);
        std::normal_distribution<> noise(0.0, 5e-4);
        double angle = 15.0 * M_PI / 180.0, speed = 0.0;
        const auto pull = [](double at) {
            return -kG / kLength * std::sin(at);
        };
        constexpr int kSteps = 20;
        constexpr double h = 1.0 / 30.0 / kSteps;
        for (int i = 0; i < 600; ++i) {
            t.push_back(i / 30.0);
            x.push_back(kLength * std::sin(angle) + noise(random));
            y.push_back(-kLength * std::cos(angle) + noise(random));
            for (int k = 0; k < kSteps; ++k) {
                const double a1 = pull(angle), v1 = speed;
                const double a2 = pull(angle + h / 2 * v1), v2 = speed + h / 2 * a1;
                const double a3 = pull(angle + h / 2 * v2), v3 = speed + h / 2 * a2;
                const double a4 = pull(angle + h * v3), v4 = speed + h * a3;
                angle += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
                speed += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
            }
        }
    }

    [[nodiscard]] std::string written(
        const std::string& head, const char* separator, char point, double scale = 1.0
    ) const {
        std::string text = head;
        for (std::size_t i = 0; i < t.size(); ++i) {
            auto line = fmt::format(
                "{1:.6f}{0}{2:.6f}{0}{3:.6f}\n", separator, t[i], scale * x[i], scale * y[i]
            );
            if (point != '.') std::replace(line.begin(), line.end(), '.', point);
            text += line;
        }
        return text;
    }
};

Trajectory read(const std::string& text, const char* columns = "", const char* units = "") {
    const auto layout = parse_table_layout(columns, units);
    EXPECT_TRUE(layout) << to_text(layout.error());
    auto table = read_trajectory_table(text, *layout, "table");
    if (!table) {
        ADD_FAILURE() << to_text(table.error());
        return {};
    }
    EXPECT_TRUE(table->warnings.empty());
    return table->trajectory;
}

Error refused(const std::string& text, const char* columns = "") {
    const auto trajectory =
        read_trajectory_table(text, parse_table_layout(columns, "").value(), "table");
    EXPECT_FALSE(trajectory);
    return trajectory ? Error{} : trajectory.error();
}

TEST(TrajectoryTable, IsReadAsTrackerPhyphoxAndLoggersWriteIt) {
    const Swing swing;
    const std::vector<std::string> tables{
        swing.written("t,x,y\n", ",", '.'),
        swing.written("\xEF\xBB\xBFmass A\n\"t (s)\",\"x (m)\",\"y (m)\"\r\n", ",", '.'),
        swing.written("Time (s);X;Y\n", ";", ','),
        swing.written("# a logger\nt\tx\ty\n", "\t", '.'),
        swing.written("t x y\n", "  ", ','),
    };
    for (const auto& table : tables) {
        const auto trajectory = read(table);
        ASSERT_EQ(trajectory.samples.size(), swing.t.size()) << table.substr(0, 60);
        for (std::size_t i = 0; i < swing.t.size(); ++i) {
            EXPECT_NEAR(static_cast<double>(trajectory.samples[i].t) * 1e-9, swing.t[i], 1e-6);
            EXPECT_NEAR(trajectory.samples[i].p_lab.x(), swing.x[i], 1e-6);
            EXPECT_NEAR(trajectory.samples[i].p_lab.z(), swing.y[i], 1e-6);
        }
    }
}

TEST(TrajectoryTable, GivesGWithAnUncertaintyThatItsNoiseExplains) {
    const Swing swing;
    const auto trajectory =
        read(swing.written("", ";", ',', 100.0), "t=1,x=2,y=3", "t=s,x=cm,y=cm");
    EXPECT_NEAR(trajectory.samples[9].sigma_p().x(), 5e-4, 1e-4);
    PendulumSettings settings;
    settings.length_m = kLength;
    settings.length_u_m = 1e-4;
    settings.body = {0.0, 0.0, 0.0, 0.0};
    settings.latitude_deg = 0.0;
    const auto result = analyse_pendulum(trajectory, settings);
    ASSERT_TRUE(result) << to_text(result.error());
    const auto& g = result->measurements.front();
    ASSERT_EQ(g.name, "g");
    EXPECT_NEAR(g.value, kG, 3.0 * g.u);
    EXPECT_LT(g.u, 5e-3);
}

TEST(TrajectoryTable, TheLastRowMayBeOfWholeNumbers) {
    for (const char* last : {"9;2;3\n", "9;;\n"}) {
        std::string text = "t;x;y\n";
        for (int i = 0; i < 9; ++i)
            text += fmt::format("{},5;2,5;3,5\n", i);
        EXPECT_EQ(read(text + last).samples[0].p_lab.x(), 2.5);
    }
    std::string text = "t, x, y\n";
    for (int i = 0; i < 9; ++i)
        text += fmt::format("{}.5, 2.5, 3.5\n", i);
    EXPECT_EQ(read(text + "9, 2, 3\n").samples[0].p_lab.x(), 2.5);
}

TEST(TrajectoryTable, ThreeDimensionsAndGaps) {
    std::string text = "t,x,y,z\n";
    for (int i = 0; i < 12; ++i)
        text += fmt::format("{},{},2,3\n", i, i == 5 ? "" : "1");
    const auto trajectory = read(text);
    ASSERT_EQ(trajectory.samples.size(), 12U);
    EXPECT_EQ(trajectory.samples[4].p_lab, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_EQ(trajectory.samples[5].status, TrackStatus::lost);
}

TEST(TrajectoryTable, WhatCannotBeReadIsRefusedWithItsLine) {
    const std::string good = "t,x,y\n0,1,1\n1,1,1\n";
    EXPECT_EQ(refused("").message, "is empty");
    EXPECT_EQ(refused("t,x,y\n").message, "has no row of numbers");
    EXPECT_EQ(refused(good).message, "has 2 rows");
    EXPECT_EQ(refused(good + "1,1,1\n").message, "line 4: the time does not increase");
    EXPECT_EQ(refused(good + "2,a,1\n3,1,1\n").message, "line 4: 'a' is no number");
    EXPECT_EQ(refused(good + ",1,1\n3,1,1\n").message, "line 4 has no time");
    EXPECT_EQ(
        refused(good + "2e9,1,1\n").message,
        "line 4: the time is more than three years from the first"
    );
    EXPECT_EQ(refused(good, "t=t,x=a,y=b").message, "has no column 'a'; it has 3: t, x, y");
    EXPECT_EQ(refused("0 1\n1 2\n").message, "has no column 't'; it has 2 without heads");
    EXPECT_EQ(refused(good, "t=1,x=2,y=9").message, "has no column '9'; it has 3: t, x, y");
}

}  // namespace
}  // namespace kinectlab::experiments
