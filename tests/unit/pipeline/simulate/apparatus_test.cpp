// What all apparatuses have in common.
#include "pipeline/simulate/apparatus.hpp"

#include <cmath>

#include "pipeline/simulate/apparatus_text.hpp"
#include "pipeline/simulate/depth_caster.hpp"
#include "pipeline/simulate/simulated_rig.hpp"
#include "tests/unit/pipeline/simulate/apparatus_support.hpp"

namespace kinectlab::simulate {
namespace {

SimulatedRig rig_of(const std::string& name, bool with_colour = false) {
    RigSettings settings;
    settings.apparatus.name = name;
    settings.noise = NoiseModel::none;
    settings.with_colour = with_colour;
    auto rig = SimulatedRig::create(settings);
    EXPECT_TRUE(rig);
    return std::move(*rig);
}

/// Distance of a point of the body's frame from its surface, m.
double off_surface(const Shape& shape, const Eigen::Vector3d& p) {
    if (const auto* ball = std::get_if<Sphere>(&shape)) return std::abs(p.norm() - ball->radius_m);
    const Eigen::Vector3d beyond = p.cwiseAbs() - 0.5 * std::get<Cuboid>(shape).size_m;
    return std::abs(beyond.maxCoeff());
}

TEST(Apparatus, LeavesTheSceneFreeBeforeAndAfter) {
    for (const std::string& name : apparatus_names()) {
        if (name == "pendulum") continue;
        SimulatedRig rig = rig_of(name);
        RgbdFrame empty, now;
        rig.render(empty);
        double t = 0.0;
        for (int round = 0; round < 2; ++round) {
            ASSERT_TRUE(rig.apply({Action::displace, rig.apparatus().usual_value()}));
            rig.advance_to(t += 2.5);
            ASSERT_TRUE(rig.apply({Action::release}));
            rig.advance_to(t += 1.0);
            rig.render(now);
            EXPECT_NE(now.depth, empty.depth) << name;
            ASSERT_TRUE(rig.apply({Action::stop}));
            rig.advance_to(t += 3.0);
            EXPECT_EQ(rig.apparatus().motion(), Motion::at_rest) << name;
            rig.render(now);
            EXPECT_EQ(now.depth, empty.depth) << name;
        }
    }
}

TEST(Apparatus, ShowsItsBodiesWhereTheTruthSays) {
    for (const std::string& name : apparatus_names()) {
        SimulatedRig rig = rig_of(name);
        ASSERT_TRUE(rig.apply({Action::displace, rig.apparatus().usual_value()}));
        rig.advance_to(3.0);
        ASSERT_TRUE(rig.apply({Action::release}));
        rig.advance_to(3.4);
        RgbdFrame frame;
        rig.render(frame);
        const Pinhole& camera = rig.camera().depth;
        const Eigen::Isometry3d T_cam_lab = rig.T_lab_cam().inverse();
        for (const Body& body : rig.truth().bodies) {
            const Eigen::Isometry3d T_cam_body = T_cam_body_of(T_cam_lab, body);
            const PixelRect rect = picture_of(camera, body.shape, T_cam_body);
            int on_it = 0;
            for (int v = rect.top; v < rect.bottom; ++v) {
                for (int u = rect.left; u < rect.right; ++u) {
                    const double z =
                        1e-3 * frame.depth[static_cast<std::size_t>(v) * camera.width + u];
                    const Eigen::Vector3d p = T_cam_body.inverse() * (z * camera.ray(u, v));
                    if (p.norm() > reach_of(body.shape) + 0.002) continue;
                    on_it += off_surface(body.shape, p) < 8e-4 ? 1 : 0;
                }
            }
            const double depth = T_cam_body.translation().z();
            const double radius_px = camera.fx * ball_radius_of(body.shape) / depth;
            EXPECT_GT(on_it, 0.9 * 3.14 * radius_px * radius_px) << name << " " << body.name;
        }
    }
}

TEST(Apparatus, FacesOfABoxHaveColoursOfTheirOwn) {
    SimulatedRig rig = rig_of("tumbler", true);
    ASSERT_TRUE(rig.apply({Action::displace, 0.0}));
    rig.advance_to(3.0);
    RgbdFrame frame;
    rig.render(frame);
    const Body box = rig.truth().body();
    const RgbdCamera& camera = rig.camera();
    const Eigen::Isometry3d T_cam_body =
        camera.T_colour_depth * T_cam_body_of(rig.T_lab_cam().inverse(), box);
    const auto colour_at = [&](const Eigen::Vector3d& p_body) {
        const Eigen::Vector2d uv = camera.colour.project(T_cam_body * p_body);
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int dv = -4; dv <= 4; ++dv)
            for (int du = -4; du <= 4; ++du)
                for (int c = 0; c < 3; ++c)
                    sum[c] += frame.rgb[static_cast<std::size_t>(
                        3 * ((std::lround(uv.y()) + dv) * 640 + std::lround(uv.x()) + du) + c
                    )];
        return Eigen::Vector3d(sum.normalized());
    };
    const Eigen::Vector3d half = 0.5 * std::get<Cuboid>(box.shape).size_m;
    std::vector<Eigen::Vector3d> seen;
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d towards = T_cam_body.linear().col(axis);
        const double side = towards.dot(T_cam_body.translation()) > 0.0 ? -1.0 : 1.0;
        seen.push_back(colour_at(side * half[axis] * Eigen::Vector3d::Unit(axis)));
    }
    EXPECT_LT(seen[0].dot(seen[1]), 0.97);
    EXPECT_LT(seen[1].dot(seen[2]), 0.97);
    EXPECT_LT(seen[2].dot(seen[0]), 0.97);
}

TEST(Apparatus, MovesAlikeHoweverOftenItIsAsked) {
    for (const std::string& name : apparatus_names()) {
        auto often = released(name);
        auto seldom = released(name);
        for (double t = 0.0; t < 4.0; t += 0.0071)
            (void)after(*often, t);
        const Body a = after(*often, 4.0);
        const Body b = after(*seldom, 4.0);
        EXPECT_LT((a.p_lab - b.p_lab).norm(), 1e-10) << name;
        EXPECT_LT(a.q_lab_body.angularDistance(b.q_lab_body), 1e-7) << name;
    }
}

TEST(Apparatus, IsHeldInMidMotion) {
    for (const std::string& name : apparatus_names()) {
        auto apparatus = released(name, {}, name == "spring" || name == "pendulum" ? 0.1 : 0.0);
        (void)after(*apparatus, 0.3);
        ASSERT_TRUE(apparatus->apply({Action::hold}));
        EXPECT_EQ(apparatus->motion(), Motion::held);
        const Body there = after(*apparatus, 0.3);
        const Body later = after(*apparatus, 1.0);
        EXPECT_EQ(there.p_lab, later.p_lab) << name;
        EXPECT_EQ(later.v_lab.norm() + later.w_lab.norm(), 0.0) << name;
        ASSERT_TRUE(apparatus->apply({Action::release}));
        EXPECT_LT((after(*apparatus, 1.001).p_lab - later.p_lab).norm(), 1e-3) << name;
    }
}

TEST(Apparatus, RefusesWhatItIsNotOrHasNot) {
    const auto field_of = [](const std::string& name, const ParameterMap& given) {
        const auto apparatus = make_apparatus({name, given});
        return apparatus ? std::string() : apparatus.error().field;
    };
    EXPECT_EQ(field_of("sprong", {}), "apparatus");
    for (const std::string& name : apparatus_names()) {
        EXPECT_EQ(field_of(name, {{"colour", 1.0}}), "colour") << name;
        const auto ranges = parameters_of(name);
        for (const ParameterRange& range : *ranges) {
            const std::string parameter(range.name);
            EXPECT_EQ(field_of(name, {{parameter, range.maximum + 1.0}}), parameter) << name;
            EXPECT_EQ(field_of(name, {{parameter, std::nan("")}}), parameter) << name;
        }
        EXPECT_FALSE(made(name)->apply({Action::displace, 5.0})) << name;
        EXPECT_FALSE(made(name)->apply({Action::displace, std::nan("")})) << name;
    }
    EXPECT_EQ(field_of("pendulum", {{"string_mass_kg", 0.1}}), "string_mass_kg");
    EXPECT_EQ(field_of("collision", {{"offset_m", 0.09}}), "offset_m");
    EXPECT_TRUE(make_apparatus({"incline", {{"frikton", 1.0}}})
                    .error()
                    .cure.starts_with("did you mean friction? Valid: "));
}

TEST(Apparatus, IsToldAsOneLine) {
    const ApparatusSettings settings{"incline", {{"friction", 0.1}, {"incline_deg", 12.25}}};
    EXPECT_EQ(to_text(settings), "incline friction=0.1 incline_deg=12.25");
    const auto read = parse_apparatus("  incline incline_deg=12.25  friction=1e-1 ");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->name, "incline");
    EXPECT_EQ(read->parameters, settings.parameters);
    for (const char* wrong :
         {"",
          "friction=1",
          "incline friction",
          "incline =1",
          "incline a=1 a=2",
          "incline a=1x",
          "incline a="})
        EXPECT_FALSE(parse_apparatus(wrong)) << wrong;
    const auto own = settings_for("incline", {{"friction", 0.1}, {"duration_s", 30.0}});
    ASSERT_TRUE(own);
    EXPECT_EQ(own->parameters, (ParameterMap{{"friction", 0.1}}));
}

}  // namespace
}  // namespace kinectlab::simulate
