#include "pipeline/simulate/spring.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/simulate/carried_apparatus.hpp"
#include "pipeline/simulate/fixed_grid.hpp"

namespace kinectlab::simulate {
namespace {

constexpr std::array kRanges = {
    ParameterRange{"stiffness_n_m", 1.0, 200.0, 10.0},
    ParameterRange{"mass_kg", 0.05, 2.0, 0.25},
    ParameterRange{"ball_radius_m", 0.02, 0.06, 0.04},
    ParameterRange{"damping_per_s", 0.0, 2.0, 0.05},
    ParameterRange{"gravity", 0.5, 30.0, 9.81},
    ParameterRange{"drive_hz", 0.0, 5.0, 0.0},
    ParameterRange{"drive_amplitude_m", 0.0, 0.1, 0.0},
};

constexpr double kRest = 1.10;        ///< height of the ball's centre
constexpr double kSuspension = 1.95;  ///< height of the string's upper end, above the picture
constexpr double kWoundUp = 1.2;      ///< so much higher is all that, stopped
constexpr double kFarthest = 0.3;
constexpr double kLargestSwing = 0.4;

std::vector<Body> parked(double radius) {
    Body ball{"ball", Sphere{radius}, Material::blue_ball};
    ball.p_lab = {0.0, 0.0, kRest + kWoundUp};
    return {ball};
}

class Spring final : public CarriedApparatus {
public:
    explicit Spring(const ParameterMap& p)
        : CarriedApparatus(parked(p.at("ball_radius_m"))),
          rate_2_(p.at("stiffness_n_m") / p.at("mass_kg")),
          damping_(p.at("damping_per_s")),
          drive_amplitude_(p.at("drive_amplitude_m")),
          drive_rate_(2.0 * std::numbers::pi * p.at("drive_hz")) {}

    double value() const override {
        return motion() == Motion::at_rest ? 0.0 : kRest - bodies().front().p_lab.z();
    }

    std::vector<Wire> wires() const override {
        const Eigen::Vector3d ball = bodies().front().p_lab;
        const double lifted = std::max(0.0, ball.z() - kRest - kFarthest);
        return {{Eigen::Vector3d(0.0, 0.0, kSuspension + lifted), ball}};
    }

    Furniture furniture() const override { return {true, std::nullopt, {}}; }
    double usual_value() const override { return 0.1; }

protected:
    double least_value() const override { return -kFarthest; }
    double largest_value() const override { return kFarthest; }

    void set_up(double value, std::vector<Body>& bodies) const override {
        bodies.front().p_lab = {0.0, 0.0, kRest - value};
    }

    void let_go(bool, std::vector<Body>& bodies) override {
        const Swing::State start(bodies.front().p_lab.z() - kRest, 0.0);
        const auto slope = [rate_2 = rate_2_,
                            damping = damping_,
                            amplitude = drive_amplitude_,
                            rate = drive_rate_](double t, const Swing::State& s) {
            const double stretched = amplitude * std::sin(rate * t) - s[0];
            return Swing::State(s[1], rate_2 * stretched - 2.0 * damping * s[1]);
        };
        swing_.emplace(slope, start);
    }

    void follow(double t_s, std::vector<Body>& bodies) override {
        const Swing::State now = swing_->at(t_s);
        bodies.front().p_lab.z() = kRest + now[0];
        bodies.front().v_lab.z() = now[1];
    }

private:
    using Swing = FixedGrid<2>;
    double rate_2_;  ///< k/m, 1/s²
    double damping_, drive_amplitude_, drive_rate_;
    std::optional<Swing> swing_;
};

/// How far the ball swings when the drive has been on for long, for each metre of the drive.
double gain(const ParameterMap& p) {
    const double rate_2 = p.at("stiffness_n_m") / p.at("mass_kg");
    const double drive = 2.0 * std::numbers::pi * p.at("drive_hz");
    return rate_2 / std::hypot(rate_2 - drive * drive, 2.0 * p.at("damping_per_s") * drive);
}

}  // namespace

std::span<const ParameterRange> spring_ranges() {
    return kRanges;
}

Result<std::unique_ptr<Apparatus>> make_spring(const ParameterMap& given) {
    const auto parameters = complete("spring", kRanges, given);
    if (!parameters) return tl::unexpected(parameters.error());
    const double amplitude = parameters->at("drive_amplitude_m");
    const double most = kLargestSwing / gain(*parameters);
    if (parameters->at("drive_hz") > 0.0 && amplitude > most)
        return fail(
            ErrorCode::invalid_argument,
            "drive_amplitude_m",
            "is " + shortest_text(amplitude) + ", which would swing the ball out of the picture",
            "give at most " + shortest_text(std::floor(1e4 * most) / 1e4) + ", or more damping"
        );
    return std::make_unique<Spring>(*parameters);
}

}  // namespace kinectlab::simulate
