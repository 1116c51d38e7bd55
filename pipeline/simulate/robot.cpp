#include "pipeline/simulate/robot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/simulate/carried_apparatus.hpp"

namespace kinectlab::simulate {
namespace {

constexpr std::array kRanges = {
    ParameterRange{"speed_m_s", 0.02, 0.5, 0.15},
    ParameterRange{"turning_deg_s", 5.0, 180.0, 60.0},
    ParameterRange{"length_m", 0.06, 0.25, 0.16},
    ParameterRange{"width_m", 0.06, 0.25, 0.10},
    ParameterRange{"height_m", 0.05, 0.25, 0.12},
};

constexpr double kStraight = 0.5;
constexpr double kLeastRadius = 0.05;
constexpr double kLargestRadius = 0.14;

/// A leg of the course: so long at this speed while turning to the left at this rate.
struct Leg {
    double seconds, speed_m_s, rate_rad_s;
};

/// Where the robot's centre is on the table, and where it heads.
struct Place {
    double x, y, heading;

    [[nodiscard]] Place after(const Leg& leg, double t_s) const {
        const double turned = heading + leg.rate_rad_s * t_s;
        if (leg.rate_rad_s == 0.0)
            return {
                x + leg.speed_m_s * t_s * std::cos(heading),
                y + leg.speed_m_s * t_s * std::sin(heading),
                turned};
        const double radius = leg.speed_m_s / leg.rate_rad_s;
        return {
            x + radius * (std::sin(turned) - std::sin(heading)),
            y - radius * (std::cos(turned) - std::cos(heading)),
            turned};
    }
};

class Robot final : public CarriedApparatus {
public:
    explicit Robot(const ParameterMap& p) : CarriedApparatus(parked(p)) {
        const double speed = p.at("speed_m_s");
        const double rate = p.at("turning_deg_s") * std::numbers::pi / 180.0;
        radius_ = std::clamp(speed / rate, kLeastRadius, kLargestRadius);
        const double half_turn = std::numbers::pi / rate;
        course_ = {
            Leg{kStraight / speed, speed, 0.0},
            Leg{half_turn, rate * radius_, rate},
            Leg{kStraight / speed, speed, 0.0},
            Leg{0.5 * half_turn, 0.0, rate},
            Leg{2.0 * radius_ / speed, speed, 0.0},
            Leg{0.5 * half_turn, 0.0, rate}};
    }

    Furniture furniture() const override { return {true, std::nullopt, {}}; }

protected:
    void set_up(double, std::vector<Body>& bodies) const override {
        Body& robot = bodies.front();
        robot.p_lab = {-0.5 * kStraight, -radius_, robot.p_lab.z()};
        robot.q_lab_body = Eigen::Quaterniond::Identity();
    }

    void let_go(bool anew, std::vector<Body>&) override { driven_s_ = anew ? 0.0 : reached_s_; }

    void follow(double t_s, std::vector<Body>& bodies) override {
        Body& robot = bodies.front();
        reached_s_ = driven_s_ + t_s;
        double round_s = 0.0;
        for (const Leg& leg : course_)
            round_s += leg.seconds;
        double left = std::fmod(reached_s_, round_s);
        Place place{-0.5 * kStraight, -radius_, 0.0};
        const Leg* leg = course_.data();
        for (; leg != &course_.back() && left >= leg->seconds; ++leg) {
            place = place.after(*leg, leg->seconds);
            left -= leg->seconds;
        }
        place = place.after(*leg, left);
        robot.p_lab.head<2>() = Eigen::Vector2d(place.x, place.y);
        robot.q_lab_body = Eigen::AngleAxisd(place.heading, Eigen::Vector3d::UnitZ());
        robot.v_lab =
            leg->speed_m_s * Eigen::Vector3d(std::cos(place.heading), std::sin(place.heading), 0.0);
        robot.w_lab = leg->rate_rad_s * Eigen::Vector3d::UnitZ();
    }

private:
    static std::vector<Body> parked(const ParameterMap& p) {
        const Eigen::Vector3d size(p.at("length_m"), p.at("width_m"), p.at("height_m"));
        Body robot{"robot", Cuboid{size}, Material::painted_box};
        robot.p_lab = {-1.7, 0.0, room::kTableTop + 0.5 * size.z()};
        return {robot};
    }

    double radius_ = 0.0;
    std::array<Leg, 6> course_{};
    double driven_s_ = 0.0, reached_s_ = 0.0;  ///< of the course, before and after the release
};

}  // namespace

std::span<const ParameterRange> robot_ranges() {
    return kRanges;
}

Result<std::unique_ptr<Apparatus>> make_robot(const ParameterMap& given) {
    const auto parameters = complete("robot", kRanges, given);
    if (!parameters) return tl::unexpected(parameters.error());
    return std::make_unique<Robot>(*parameters);
}

}  // namespace kinectlab::simulate
