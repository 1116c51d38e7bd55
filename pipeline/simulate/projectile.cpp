#include "pipeline/simulate/projectile.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/simulate/carried_apparatus.hpp"
#include "pipeline/simulate/fixed_grid.hpp"

namespace kinectlab::simulate {
namespace {

constexpr std::array kRanges = {
    ParameterRange{"ball_radius_m", 0.015, 0.06, 0.03},
    ParameterRange{"ball_density_kg_m3", 20.0, 20000.0, 900.0},
    ParameterRange{"speed_m_s", 0.0, 4.0, 2.2},
    ParameterRange{"elevation_deg", -80.0, 90.0, 45.0},
    ParameterRange{"gravity", 0.5, 30.0, 9.81},
    ParameterRange{"air_density_kg_m3", 0.0, 10.0, 1.2},
    ParameterRange{"drag_coefficient", 0.0, 2.0, 0.47},
};

constexpr double kTrayTop = 0.52;
constexpr double kTrayHalfX = 0.85;
constexpr double kTrayHalfY = 0.15;

const Eigen::Vector3d& launcher() {
    static const Eigen::Vector3d place(-0.70, 0.0, 1.45);
    return place;
}

std::vector<Body> parked(double radius) {
    Body ball{"ball", Sphere{radius}, Material::yellow_ball};
    ball.p_lab = {-1.5, 0.0, launcher().z()};
    return {ball};
}

class Projectile final : public CarriedApparatus {
public:
    explicit Projectile(const ParameterMap& p)
        : CarriedApparatus(parked(p.at("ball_radius_m"))),
          radius_(p.at("ball_radius_m")),
          added_(1.0 + 0.5 * p.at("air_density_kg_m3") / p.at("ball_density_kg_m3")),
          gravity_(
              p.at("gravity") * (1.0 - p.at("air_density_kg_m3") / p.at("ball_density_kg_m3")) /
              added_
          ),
          drag_(
              0.375 * p.at("drag_coefficient") * p.at("air_density_kg_m3") /
              (p.at("ball_density_kg_m3") * radius_ * added_)
          ) {
        const double elevation = p.at("elevation_deg") * std::numbers::pi / 180.0;
        launch_ =
            p.at("speed_m_s") * Eigen::Vector3d(std::cos(elevation), 0.0, std::sin(elevation));
    }

    Furniture furniture() const override {
        Block tray;
        tray.T_lab_block.translation() = Eigen::Vector3d(0.0, 0.0, 0.5 * kTrayTop);
        tray.size_m = {2.0 * kTrayHalfX, 2.0 * kTrayHalfY, kTrayTop};
        tray.material = Material::sand;
        return {false, std::nullopt, {tray}};
    }

protected:
    void set_up(double, std::vector<Body>& bodies) const override {
        bodies.front().p_lab = launcher();
    }

    void let_go(bool anew, std::vector<Body>& bodies) override {
        if (anew) bodies.front().v_lab = launch_;
        Flight::State start;
        start << bodies.front().p_lab, bodies.front().v_lab;
        flight_.emplace(
            [gravity = gravity_, drag = drag_](double, const Flight::State& s) {
                const Eigen::Vector3d v = s.tail<3>();
                Flight::State slope;
                slope << v, -gravity * Eigen::Vector3d::UnitZ() - drag * v.norm() * v;
                return slope;
            },
            start
        );
        landed_ = false;
    }

    void follow(double t_s, std::vector<Body>& bodies) override {
        Body& ball = bodies.front();
        while (!landed_) {
            const double dt = std::min(t_s - flight_->grid_s(), Flight::kStep);
            const Flight::State next = flight_->step(dt);
            if (below_ground(next)) {
                land(dt, ball);
            } else if (dt < Flight::kStep) {
                ball.p_lab = next.head<3>();
                ball.v_lab = next.tail<3>();
                return;
            } else {
                flight_->advance(flight_->grid_s() + Flight::kStep);
            }
        }
    }

private:
    using Flight = FixedGrid<6>;

    [[nodiscard]] bool below_ground(const Flight::State& s) const {
        const double ground = std::abs(s[0]) <= kTrayHalfX ? kTrayTop : 0.0;
        return s[2] - radius_ < ground && s[5] < 0.0;
    }

    /// Within `dt` after the last grid point.
    void land(double dt, Body& ball) {
        double above = 0.0;
        for (double below = dt; below - above > 1e-12;) {
            const double middle = 0.5 * (above + below);
            (below_ground(flight_->step(middle)) ? below : above) = middle;
        }
        ball.p_lab = flight_->step(above).head<3>();
        ball.v_lab.setZero();
        landed_ = true;
    }

    double radius_;
    double added_;    ///< a ball draws half the mass of the air it displaces along (Stokes 1850)
    double gravity_;  ///< m/s², what buoyancy leaves of it
    double drag_;     ///< 1/m
    Eigen::Vector3d launch_;
    std::optional<Flight> flight_;
    bool landed_ = false;
};

}  // namespace

std::span<const ParameterRange> projectile_ranges() {
    return kRanges;
}

Result<std::unique_ptr<Apparatus>> make_projectile(const ParameterMap& given) {
    const auto parameters = complete("projectile", kRanges, given);
    if (!parameters) return tl::unexpected(parameters.error());
    return std::make_unique<Projectile>(*parameters);
}

}  // namespace kinectlab::simulate
