#include "server/experiments/poses_csv.hpp"

#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kinectlab::experiments {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
        if (c == ',') {
            cells.emplace_back();
        } else if (c != '\n') {
            cells.back() += c;
        }
    }
    return cells;
}

MotionSample sample() {
    MotionSample s;
    s.t = 1'767'225'600'033'333'333;
    s.status = TrackStatus::tracked;
    s.has_orientation = true;
    s.p_lab = {0.1, -0.2, 1e-17};
    s.q_lab_obj = Eigen::Quaterniond(0.5, 0.1, 0.2, 0.3);
    s.covariance.diagonal().setConstant(4e-6);
    s.v_lab = {1, 2, 3};
    s.w_lab = {4, 5, 6};
    s.quality = {1200, 0.9, 0.6};
    s.size.radius_m = 0.05;
    s.size.radius_u = 0.001;
    return s;
}

TEST(PosesCsv, HasTheColumnsOfTheContract) {
    EXPECT_EQ(
        poses_csv_header(),
        "t_ns,object,status,x,y,z,qx,qy,qz,qw,sx,sy,sz,vx,vy,vz,wx,wy,wz,"
        "srx,sry,srz,radius,s_radius,half_angle,s_half_angle,points,inlier_share,rms_steps\n"
    );
    std::string csv;
    append_pose_row(csv, "bob", sample());
    EXPECT_EQ(
        csv,
        "1767225600033333333,bob,tracked,0.1,-0.2,1e-17,0.1,0.2,0.3,0.5,0.002,0.002,0.002,"
        "1,2,3,4,5,6,0.002,0.002,0.002,0.05,0.001,,,1200,0.9,0.6\n"
    );
}

TEST(PosesCsv, WhatWasNotMeasuredIsEmpty) {
    MotionSample lost = sample();
    lost.status = TrackStatus::lost;
    std::string csv;
    append_pose_row(csv, "bob", lost);
    EXPECT_EQ(csv, "1767225600033333333,bob,lost" + std::string(26, ',') + "\n");

    MotionSample ball = sample();
    ball.has_orientation = false;
    ball.v_lab.setConstant(std::numeric_limits<double>::quiet_NaN());
    csv.clear();
    append_pose_row(csv, "bob", ball);
    const auto cells = cells_of(csv);
    ASSERT_EQ(cells.size(), 29u);
    for (const std::size_t column : {6, 7, 8, 9, 13, 14, 15, 16, 17, 18, 19, 20, 21})
        EXPECT_EQ(cells[column], "") << column;
    EXPECT_EQ(cells[3], "0.1");
    EXPECT_EQ(cells[22], "0.05");

    MotionSample filled = sample();
    filled.status = TrackStatus::interpolated;
    filled.covariance.bottomRightCorner<3, 3>().setZero();  // as the laboratory keeps it
    csv.clear();
    append_pose_row(csv, "bob", filled);
    const auto between = cells_of(csv);
    for (std::size_t column = 19; column < 29; ++column)
        EXPECT_EQ(between[column], "") << column;
}

RC_GTEST_PROP(PosesCsv, NumbersComeBackExactly, (double x, double y)) {
    MotionSample s = sample();
    s.p_lab.x() = x;
    s.v_lab.y() = y;
    std::string csv;
    append_pose_row(csv, "bob", s);
    const auto cells = cells_of(csv);
    RC_ASSERT(std::strtod(cells[3].c_str(), nullptr) == x);
    RC_ASSERT(std::strtod(cells[14].c_str(), nullptr) == y);
}

}  // namespace
}  // namespace kinectlab::experiments
