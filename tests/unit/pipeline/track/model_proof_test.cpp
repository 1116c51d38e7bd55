#include "pipeline/track/model_proof.hpp"

#include <gtest/gtest.h>

#include "pipeline/track/object_model.hpp"
#include "tests/unit/pipeline/support/mesh_room.hpp"

namespace kinectlab {
namespace {

using test::MeshRoom;

Eigen::Isometry3d pose(double x, double z, double turn) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(x, 0.0, z);
    T.linear() = (Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(0.5 * turn, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
    return T;
}

/// What a picture of `things` says against `searched` at T.
ModelProof proof(
    const std::vector<test::Thing>& things, const TriangleMesh& searched, const Eigen::Isometry3d& T
) {
    MeshRoom room(7);
    const auto model = make_object_model(searched);
    ModelViewer viewer(room.camera.depth, {});
    const auto frame = room.frame(things);
    return prove(
        frame.depth, room.camera.depth, DisparityScale(room.camera), viewer.look(*model, T), T
    );
}

TEST(ModelProof, NothingSpeaksAgainstTheThingItself) {
    const auto box = test::box_mesh(0.16, 0.10, 0.12);
    for (const double turn : {0.0, 0.3, 0.8}) {
        const auto found = proof({{box, pose(0.05, 1.2, turn)}}, box, pose(0.05, 1.2, turn));
        EXPECT_LT(found.misfit_share, 0.08) << turn;
        EXPECT_LT(found.goes_on_share, 0.05) << turn;
    }
}

TEST(ModelProof, APartOfALargerFaceGoesOn) {
    const auto small = test::box_mesh(0.10, 0.08, 0.10);
    const auto large = test::box_mesh(0.30, 0.20, 0.10);
    const auto T = pose(0.0, 1.2, 0.0);
    EXPECT_GT(proof({{large, T}}, small, T).goes_on_share, 0.9);
    // Two of its sides end where the larger one's do.
    Eigen::Isometry3d corner = T;
    corner.translation() += Eigen::Vector3d(0.10, 0.06, 0.0);
    const double share = proof({{large, T}}, small, corner).goes_on_share;
    EXPECT_GT(share, 0.3);
    EXPECT_LT(share, 0.7);
}

TEST(ModelProof, AnotherShapeMisfits) {
    const auto tin = test::turned_mesh({{.001, -.06}, {.05, -.06}, {.05, .06}, {.001, .06}}, 64);
    const auto box = test::box_mesh(0.08, 0.12, 0.08);
    const auto found = proof({{tin, pose(0.0, 1.0, 0.0)}}, box, pose(0.0, 0.995, 0.0));
    EXPECT_GT(found.misfit_share, 0.15);
}

TEST(ModelProof, WhatHidesItSaysNothing) {
    const auto box = test::box_mesh(0.16, 0.10, 0.12);
    const auto T = pose(0.0, 1.4, 0.3);
    const auto found =
        proof({{box, T}, {test::box_mesh(0.12, 0.3, 0.02), pose(0.1, 0.9, 0.0)}}, box, T);
    EXPECT_LT(found.misfit_share, 0.08);
    EXPECT_LT(found.goes_on_share, 0.05);
}

}  // namespace
}  // namespace kinectlab
