// Every apparatus from its frames to poses, as an experiment does it: the scene is learned at rest,
// then everything that the definition names is followed, with a Kinect's noise.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "pipeline/simulate/simulate_run.hpp"

namespace kinectlab {
namespace {

/// A box's surface, its frame at the centre.
std::shared_ptr<const TriangleMesh> box_mesh(const Eigen::Vector3d& size) {
    auto mesh = std::make_shared<TriangleMesh>();
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign(
            corner & 4U ? 1 : -1, corner & 2U ? 1 : -1, corner & 1U ? 1 : -1
        );
        mesh->vertices.push_back((0.5 * sign.cwiseProduct(size)).cast<float>());
    }
    using Quad = std::array<std::uint32_t, 4>;
    for (const auto& [a, b, c, d] :
         {Quad{0, 1, 3, 2},
          Quad{4, 6, 7, 5},
          Quad{0, 4, 5, 1},
          Quad{2, 3, 7, 6},
          Quad{0, 2, 6, 4},
          Quad{1, 5, 7, 3}}) {
        mesh->triangles.push_back({a, b, c});
        mesh->triangles.push_back({a, c, d});
    }
    return mesh;
}

struct Followed {
    int in_view = 0, tracked = 0, wrong = 0;
    double square_over_claimed = 0.0;
    double largest_turn_off = 0.0;  ///< rad, up to the box's own symmetries
};

bool well_in_view(const Pinhole& camera, const Eigen::Vector3d& p_cam) {
    const Eigen::Vector2d uv = camera.project(p_cam);
    return uv.x() > 30.0 && uv.x() < 600.0 && uv.y() > 30.0 && uv.y() < 450.0;
}

double turn_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
    double least = a.angularDistance(b);
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::AngleAxisd half(std::acos(-1.0), Eigen::Vector3d::Unit(axis));
        least = std::min(least, a.angularDistance(b * Eigen::Quaterniond(half)));
    }
    return least;
}

std::vector<Followed> follow(
    const simulate::ApparatusSettings& apparatus, std::vector<ObjectSpec> objects, double seconds
) {
    simulate::RunSettings run;
    run.rig.apparatus = apparatus;
    run.rig.with_colour = false;
    run.rig.seed = 3;
    run.seconds = seconds;
    const auto rig = simulate::SimulatedRig::create(run.rig);
    Chain chain = std::move(Chain::create({rig->camera(), objects}).value());
    const Eigen::Isometry3d T_cam_lab = rig->T_lab_cam().inverse();
    std::vector<Followed> all(objects.size());
    const auto sink = [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
        if (truth.motion == simulate::Motion::at_rest) return chain.learn(frame);
        const auto samples = chain.track(frame).value();
        if (truth.motion != simulate::Motion::free) return {};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const TrackSample& sample = samples[i];
            const simulate::Body& body = truth.bodies[i];
            const Eigen::Vector3d p_cam = T_cam_lab * body.p_lab;
            if (!well_in_view(rig->camera().depth, p_cam)) continue;
            ++all[i].in_view;
            if (sample.status != TrackStatus::tracked) continue;
            ++all[i].tracked;
            const Eigen::Vector3d error = sample.p_cam - p_cam;
            if (error.norm() > 0.006) ++all[i].wrong;
            const Eigen::Matrix3d covariance = sample.covariance.topLeftCorner<3, 3>();
            all[i].square_over_claimed += error.dot(covariance.inverse() * error) / 3.0;
            if (sample.has_orientation)
                all[i].largest_turn_off = std::max(
                    all[i].largest_turn_off,
                    turn_between(
                        Eigen::Quaterniond(T_cam_lab.linear()) * body.q_lab_body, sample.q_cam_obj
                    )
                );
        }
        return {};
    };
    EXPECT_TRUE(simulate::simulate_run(run, sink));
    return all;
}

void expect_followed(const Followed& f, int least_frames) {
    EXPECT_GE(f.in_view, least_frames);
    EXPECT_GE(f.tracked, 0.9 * f.in_view);
    EXPECT_LE(f.wrong, 0.02 * f.tracked);
    EXPECT_LT(f.square_over_claimed, 6.0 * f.tracked);
}

ObjectSpec ball(const std::string& name, double radius_m) {
    return {name, SphereSettings{.radius_m = radius_m}};
}

ObjectSpec box(const std::string& name, const Eigen::Vector3d& size) {
    SurfacePatchSettings settings;
    settings.model = "box";
    settings.mesh = box_mesh(size);
    return {name, settings};
}

TEST(ChainOnApparatuses, FollowsAProjectile) {
    expect_followed(follow({"projectile", {}}, {ball("ball", 0.03)}, 1.5).front(), 15);
}

TEST(ChainOnApparatuses, FollowsABallDownAnIncline) {
    expect_followed(follow({"incline", {}}, {ball("ball", 0.035)}, 2.0).front(), 55);
}

/// The sine of the largest angle between the plank and what was followed while the ball was free.
double plank_off(double incline_deg) {
    simulate::RunSettings run;
    run.rig.apparatus = {"incline", {{"incline_deg", incline_deg}}};
    run.rig.with_colour = false;
    run.rig.seed = 3;
    run.seconds = 1.0;
    const auto rig = simulate::SimulatedRig::create(run.rig);
    const std::vector<ObjectSpec> objects{
        ball("ball", 0.035), {"plank", PlaneSettings{.under = "ball"}}};
    Chain chain = std::move(Chain::create({rig->camera(), objects}).value());
    const double slope = incline_deg * std::acos(-1.0) / 180.0;
    const Eigen::Vector3d plank(std::sin(slope), 0.0, std::cos(slope));
    double off = 0.0;
    const auto sink = [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
        if (truth.motion == simulate::Motion::at_rest) return chain.learn(frame);
        const auto samples = chain.track(frame).value();
        if (truth.motion != simulate::Motion::free) return {};
        EXPECT_EQ(samples[1].status, TrackStatus::tracked) << incline_deg;
        const Eigen::Vector3d normal =
            rig->T_lab_cam().linear() * (samples[1].q_cam_obj * Eigen::Vector3d::UnitZ());
        off = std::max(off, normal.cross(plank).norm());
        return {};
    };
    EXPECT_TRUE(simulate::simulate_run(run, sink));
    return off;
}

TEST(ChainOnApparatuses, FollowsThePlankUnderTheBall) {
    for (const double incline_deg : {1.0, 8.0, 30.0})
        EXPECT_LT(plank_off(incline_deg), 0.015) << incline_deg;
}

TEST(ChainOnApparatuses, FollowsAMassOnASpring) {
    expect_followed(follow({"spring", {}}, {ball("ball", 0.04)}, 3.0).front(), 85);
}

TEST(ChainOnApparatuses, FollowsTwoBallsThroughTheirCollision) {
    for (const double offset : {0.0, 0.03}) {
        const auto balls =
            follow({"collision", {{"offset_m", offset}}}, {ball("a", 0.05), ball("b", 0.035)}, 3.5);
        expect_followed(balls[0], 100);
        expect_followed(balls[1], 100);
    }
}

TEST(ChainOnApparatuses, FollowsARobotOnItsCourse) {
    const Followed robot = follow({"robot", {}}, {box("robot", {0.16, 0.10, 0.12})}, 6.0).front();
    expect_followed(robot, 170);
    EXPECT_LT(robot.largest_turn_off, 0.07);
}

TEST(ChainOnApparatuses, FollowsATumblingBox) {
    const Followed tumbler = follow({"tumbler", {}}, {box("box", {0.20, 0.14, 0.08})}, 6.0).front();
    expect_followed(tumbler, 170);
    EXPECT_LT(tumbler.largest_turn_off, 0.07);
}

}  // namespace
}  // namespace kinectlab
