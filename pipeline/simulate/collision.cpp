#include "pipeline/simulate/collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/simulate/carried_apparatus.hpp"

namespace kinectlab::simulate {
namespace {

constexpr std::array kRanges = {
    ParameterRange{"mass_a_kg", 0.02, 2.0, 0.3},
    ParameterRange{"mass_b_kg", 0.02, 2.0, 0.2},
    ParameterRange{"radius_a_m", 0.025, 0.06, 0.05},
    ParameterRange{"radius_b_m", 0.025, 0.06, 0.035},
    ParameterRange{"speed_m_s", 0.05, 1.5, 0.5},
    ParameterRange{"restitution", 0.0, 1.0, 0.9},
    ParameterRange{"offset_m", -0.1, 0.1, 0.0},
};

constexpr double kStartA = -0.62;
constexpr double kStartB = 0.08;
// A comes into the picture before B: whoever follows both meets them in that order.
constexpr double kParkedA = -1.1;
constexpr double kParkedB = 2.8;
constexpr double kGap = 0.01;  ///< between table and the larger ball
constexpr double kBorderX = 0.74;
constexpr double kBorderY = 0.34;
constexpr double kLargestShare = 0.95;  ///< of the radii together that the offset may be

/// A body that glides at a steady speed since a time, until the border catches it.
struct Glide {
    double since_s = 0.0;
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d v = Eigen::Vector3d::Zero();

    [[nodiscard]] double caught_s() const {
        const auto reach = [](double place, double speed, double border) {
            if (speed == 0.0) return std::numeric_limits<double>::infinity();
            return std::max(0.0, (std::copysign(border, speed) - place) / speed);
        };
        return since_s +
               std::min(reach(from.x(), v.x(), kBorderX), reach(from.y(), v.y(), kBorderY));
    }
    void move(double t_s, Body& body) const {
        const double end = caught_s();
        body.p_lab = from + (std::min(t_s, end) - since_s) * v;
        body.v_lab = t_s < end ? v : Eigen::Vector3d::Zero();
    }
};

std::vector<Body> start_of(const ParameterMap& p, double a_x, double b_x) {
    const double radius_a = p.at("radius_a_m");
    const double radius_b = p.at("radius_b_m");
    const double height = room::kTableTop + kGap + std::max(radius_a, radius_b);
    Body a{"ball_a", Sphere{radius_a}, Material::bob};
    Body b{"ball_b", Sphere{radius_b}, Material::blue_ball};
    a.p_lab = {a_x, 0.0, height};
    b.p_lab = {b_x, p.at("offset_m"), height};
    return {a, b};
}

class Collision final : public CarriedApparatus {
public:
    explicit Collision(const ParameterMap& p)
        : CarriedApparatus(start_of(p, kParkedA, kParkedB)), parameters_(p) {}

    Furniture furniture() const override { return {true, std::nullopt, {}}; }

protected:
    void set_up(double, std::vector<Body>& bodies) const override {
        bodies = start_of(parameters_, kStartA, kStartB);
    }

    void let_go(bool anew, std::vector<Body>& bodies) override {
        if (anew) bodies[0].v_lab = parameters_.at("speed_m_s") * Eigen::Vector3d::UnitX();
        for (std::size_t i : {0U, 1U})
            before_[i] = after_[i] = {0.0, bodies[i].p_lab, bodies[i].v_lab};
        touch_s_ = std::numeric_limits<double>::infinity();
        if (anew) collide();
    }

    void follow(double t_s, std::vector<Body>& bodies) override {
        for (std::size_t i : {0U, 1U})
            (t_s < touch_s_ ? before_ : after_)[i].move(t_s, bodies[i]);
    }

private:
    /// B rests, so A's centre comes nearer until the radii are all that lies between.
    void collide() {
        const double reach = parameters_.at("radius_a_m") + parameters_.at("radius_b_m");
        const double aside = parameters_.at("offset_m");
        const double speed = before_[0].v.x();
        const double way = kStartB - kStartA - std::sqrt(reach * reach - aside * aside);
        touch_s_ = way / speed;
        after_[0].since_s = after_[1].since_s = touch_s_;
        after_[0].from += way * Eigen::Vector3d::UnitX();
        const Eigen::Vector3d n = (after_[1].from - after_[0].from) / reach;
        const double mass_a = parameters_.at("mass_a_kg");
        const double mass_b = parameters_.at("mass_b_kg");
        const double passed =
            (1.0 + parameters_.at("restitution")) * n.dot(before_[0].v) / (mass_a + mass_b);
        after_[0].v -= mass_b * passed * n;
        after_[1].v += mass_a * passed * n;
    }

    ParameterMap parameters_;
    std::array<Glide, 2> before_, after_;
    double touch_s_ = 0.0;
};

}  // namespace

std::span<const ParameterRange> collision_ranges() {
    return kRanges;
}

Result<std::unique_ptr<Apparatus>> make_collision(const ParameterMap& given) {
    const auto parameters = complete("collision", kRanges, given);
    if (!parameters) return tl::unexpected(parameters.error());
    const double most =
        kLargestShare * (parameters->at("radius_a_m") + parameters->at("radius_b_m"));
    if (auto ok = check_range("offset_m", parameters->at("offset_m"), -most, most); !ok)
        return tl::unexpected(ok.error());
    return std::make_unique<Collision>(*parameters);
}

}  // namespace kinectlab::simulate
