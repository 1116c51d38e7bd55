#include "pipeline/track/model_fit.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/mesh_room.hpp"

namespace kinectlab {
namespace {

using test::MeshRoom;
using test::Thing;

Eigen::Isometry3d pose(const Eigen::Vector3d& p, double about_y, double about_x) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = p;
    T.linear() = (Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
    return T;
}

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return Eigen::AngleAxisd(a.linear() * b.linear().transpose()).angle();
}

TEST(ModelFit, ABoxIsFoundToAFractionOfItsNoiseFromAStartThatIsOff) {
    MeshRoom room(2);
    const auto mesh = test::box_mesh(0.16, 0.10, 0.12);
    const auto model = make_object_model(mesh);
    ASSERT_TRUE(model.has_value());
    ModelFitter fitter(room.camera);
    double squares = 0.0, turns = 0.0, normed = 0.0;
    const int frames = 30;
    for (int i = 0; i < frames; ++i) {
        const Eigen::Isometry3d T = pose({0.01 * i - 0.15, 0.05, 1.2}, 0.4 + 0.02 * i, 0.5);
        const auto frame = room.frame({{mesh, T}});
        Eigen::Isometry3d start = T;
        start.translation() += Eigen::Vector3d(0.02, -0.015, 0.02);
        start.linear() =
            Eigen::AngleAxisd(0.12, Eigen::Vector3d(1, -1, 1).normalized()) * start.linear();
        const auto fit = fitter.fit(frame.depth, *model, start, {});
        ASSERT_TRUE(fit.has_value());
        const Eigen::Vector3d off = fit->T_cam_obj.translation() - T.translation();
        squares += off.squaredNorm();
        turns += std::pow(angle_between(fit->T_cam_obj, T), 2);
        normed += off.dot(fit->covariance.topLeftCorner<3, 3>().inverse() * off) / 3.0;
        EXPECT_GT(fit->seen_share, 0.95);
        EXPECT_GT(fit->outline_share, 0.9);
        EXPECT_LT(fit->seen_through_share, 0.05);
    }
    EXPECT_LT(std::sqrt(squares / frames), 0.0005);          // m, all three axes
    EXPECT_LT(std::sqrt(turns / frames), 0.3 * M_PI / 180);  // of a reading: 2 mm of noise
    // A straight edge along the pixels is off by one amount as a whole: not quite independent.
    EXPECT_LT(normed / frames, 9.0);
    EXPECT_GT(normed / frames, 0.1);
}

/// Mean of eᵀ Σ⁻¹ e of the position for each degree of freedom, neighbours erring together.
double normalised_error(double motion_m, double turn_rad) {
    MeshRoom room(3);
    room.shared = 0.7;
    const auto mesh = test::box_mesh(0.16, 0.10, 0.12);
    const auto model = make_object_model(mesh);
    ModelFitter fitter(room.camera);
    double normed = 0.0;
    constexpr int kFrames = 40;
    for (int i = 0; i < kFrames; ++i) {
        const Eigen::Isometry3d T = pose({motion_m * i - 0.1, 0.05, 1.2}, 0.4 + turn_rad * i, 0.5);
        const auto fit = fitter.fit(room.frame({{mesh, T}}).depth, *model, T, {});
        EXPECT_TRUE(fit.has_value());
        if (!fit) continue;
        const Eigen::Vector3d off = fit->T_cam_obj.translation() - T.translation();
        normed += off.dot(fit->covariance.topLeftCorner<3, 3>().inverse() * off) / 3.0;
    }
    return normed / kFrames;
}

TEST(ModelFit, CovarianceCoversTheErrorOfNeighboursThatErrTogetherAtRest) {
    const double error = normalised_error(0.0, 0.0);
    EXPECT_GT(error, 0.5);
    EXPECT_LT(error, 2.0);
}

TEST(ModelFit, CovarianceCoversTheErrorOfNeighboursThatErrTogetherInMotion) {
    const double error = normalised_error(0.0063, 0.021);
    EXPECT_GT(error, 0.5);
    EXPECT_LT(error, 2.0);
}

TEST(ModelFit, AFaceSquareToTheCameraIsHeldByItsOutline) {
    MeshRoom room(4);
    const auto mesh = test::box_mesh(0.16, 0.10, 0.12);
    const auto model = make_object_model(mesh);
    ModelFitter fitter(room.camera);
    const Eigen::Isometry3d T = pose({0.03, -0.02, 1.2}, 0.0, 0.0);
    const auto frame = room.frame({{mesh, T}});
    Eigen::Isometry3d start = T;
    start.translation() += Eigen::Vector3d(0.012, 0.012, 0.0);
    const auto fit = fitter.fit(frame.depth, *model, start, {});
    ASSERT_TRUE(fit.has_value());
    EXPECT_LT((fit->T_cam_obj.translation() - T.translation()).norm(), 0.0025);  // about a pixel
}

TEST(ModelFit, WhatStandsBeforeTheObjectDoesNotPullIt) {
    MeshRoom room(5);
    const auto mesh = test::box_mesh(0.16, 0.10, 0.12);
    const auto model = make_object_model(mesh);
    ModelFitter fitter(room.camera);
    const Eigen::Isometry3d T = pose({0.0, 0.0, 1.2}, 0.6, 0.5);
    const Thing bar{test::box_mesh(0.04, 0.4, 0.02), pose({0.03, 0.0, 1.0}, 0.0, 0.0)};
    const auto fit = fitter.fit(room.frame({{mesh, T}, bar}).depth, *model, T, {});
    ASSERT_TRUE(fit.has_value());
    EXPECT_LT((fit->T_cam_obj.translation() - T.translation()).norm(), 0.002);
    EXPECT_LT(fit->seen_share, 0.9);
    EXPECT_GT(fit->quality.inlier_share, 0.95);  // hidden is not the same as absent
}

TEST(ModelFit, WhereTheObjectIsNotItIsSeenThrough) {
    MeshRoom room(6);
    const auto mesh = test::box_mesh(0.16, 0.10, 0.12);
    const auto model = make_object_model(mesh);
    ModelFitter fitter(room.camera);
    const auto fit = fitter.fit(room.frame({}).depth, *model, pose({0, 0, 1.2}, 0.6, 0.5), {});
    EXPECT_LT(fit ? fit->seen_share : 0.0, 0.2);
}

TEST(ModelFit, AHoleInTheMeshAndTrianglesTurnedRoundChangeNothing) {
    MeshRoom room(7);
    const auto whole = test::box_mesh(0.16, 0.10, 0.12);
    auto holed = whole;
    holed.triangles.erase(holed.triangles.begin() + 3);
    for (std::size_t i = 0; i < holed.triangles.size(); i += 2)
        std::swap(holed.triangles[i][0], holed.triangles[i][1]);
    const auto model = make_object_model(holed);
    ModelFitter fitter(room.camera);
    const Eigen::Isometry3d T = pose({0.0, 0.0, 1.2}, 0.6, 0.5);
    const auto fit = fitter.fit(room.frame({{whole, T}}).depth, *model, T, {});
    ASSERT_TRUE(fit.has_value());
    EXPECT_LT((fit->T_cam_obj.translation() - T.translation()).norm(), 0.001);
}

TEST(ModelFit, NothingFromEmptyPicturesAndPosesOutOfSight) {
    const RgbdCamera camera;
    const auto model = make_object_model(test::box_mesh(0.16, 0.10, 0.12));
    ModelFitter fitter(camera);
    const std::vector<std::uint16_t> empty(640 * 480, 0), full(640 * 480, 1200);
    EXPECT_FALSE(fitter.fit(empty, *model, pose({0, 0, 1.2}, 0, 0), {}).has_value());
    EXPECT_FALSE(fitter.fit(full, *model, pose({5, 0, 1.2}, 0, 0), {}).has_value());
    EXPECT_FALSE(fitter.fit(full, *model, pose({0, 0, -1.2}, 0, 0), {}).has_value());
    EXPECT_NO_FATAL_FAILURE((void)fitter.fit(full, *model, pose({0, 0, 0.05}, 0.3, 0), {}));
    Eigen::Isometry3d nowhere = pose({0, 0, 1.2}, 0, 0);
    nowhere.translation().x() = std::nan("");
    EXPECT_FALSE(fitter.fit(full, *model, nowhere, {}).has_value());
}

TEST(ObjectModel, RefusesWhatHasNoSurface) {
    EXPECT_FALSE(make_object_model({}).has_value());
    EXPECT_FALSE(make_object_model({{{0, 0, 0}}, {}}).has_value());
    TriangleMesh line;
    for (int i = 0; i < 200; ++i)
        line.vertices.emplace_back(0.001F * static_cast<float>(i), 0.0F, 0.0F);
    EXPECT_FALSE(make_object_model(line).has_value());
    TriangleMesh same;
    same.vertices.assign(1000, Eigen::Vector3f(1, 2, 3));
    EXPECT_FALSE(make_object_model(same).has_value());
    const auto box = test::box_mesh(0.1, 0.1, 0.1);
    for (const double unit : {0.0, -1.0, std::nan(""), 1e-9, 1e12})
        EXPECT_FALSE(make_object_model(box, unit).has_value()) << unit;
}

TEST(ObjectModel, ManyTrianglesBecomeFewWithoutChangingTheShape) {
    std::vector<Eigen::Vector2d> profile;
    for (int i = 0; i <= 200; ++i)
        profile.emplace_back(
            0.1 * std::sin(M_PI * (i + 0.5) / 201), -0.1 * std::cos(M_PI * (i + 0.5) / 201)
        );
    const auto ball = test::turned_mesh(profile, 300);
    ASSERT_GT(ball.triangles.size(), 100'000U);
    const auto model = make_object_model(ball);
    ASSERT_TRUE(model.has_value());
    EXPECT_LE(model->triangles.size(), kMostModelTriangles);
    EXPECT_GT(model->triangles.size(), 1000U);
    for (const auto& vertex : model->vertices)
        EXPECT_NEAR(vertex.norm(), 0.1F, 0.002F);
}

}  // namespace
}  // namespace kinectlab
