#include "pipeline/simulate/tumbler.hpp"

#include <array>
#include <numbers>

#include "pipeline/simulate/carried_apparatus.hpp"
#include "pipeline/simulate/fixed_grid.hpp"

namespace kinectlab::simulate {
namespace {

constexpr std::array kRanges = {
    ParameterRange{"size_a_m", 0.04, 0.3, 0.20},
    ParameterRange{"size_b_m", 0.04, 0.3, 0.14},
    ParameterRange{"size_c_m", 0.04, 0.3, 0.08},
    ParameterRange{"rate_x_deg_s", -360.0, 360.0, 10.0},
    ParameterRange{"rate_y_deg_s", -360.0, 360.0, 60.0},
    ParameterRange{"rate_z_deg_s", -360.0, 360.0, 5.0},
};

const Eigen::Vector3d& bearing() {
    static const Eigen::Vector3d place(0.0, 0.0, 1.12);
    return place;
}

Eigen::Quaterniond held_turn() {
    return Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(0.45, Eigen::Vector3d::UnitX()) *
           Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY());
}

Eigen::Vector3d size_of(const ParameterMap& p) {
    return {p.at("size_a_m"), p.at("size_b_m"), p.at("size_c_m")};
}

std::vector<Body> parked(const ParameterMap& p) {
    Body box{"box", Cuboid{size_of(p)}, Material::painted_box};
    box.p_lab = bearing() - 1.8 * Eigen::Vector3d::UnitX();
    return {box};
}

class Tumbler final : public CarriedApparatus {
public:
    explicit Tumbler(const ParameterMap& p)
        : CarriedApparatus(parked(p)),
          rates_(
              Eigen::Vector3d(p.at("rate_x_deg_s"), p.at("rate_y_deg_s"), p.at("rate_z_deg_s")) *
              std::numbers::pi / 180.0
          ) {
        const Eigen::Vector3d squares = size_of(p).cwiseAbs2();
        inertia_ = Eigen::Vector3d::Constant(squares.sum()) - squares;
    }

    Furniture furniture() const override { return {true, std::nullopt, {}}; }

protected:
    void set_up(double, std::vector<Body>& bodies) const override {
        bodies.front().p_lab = bearing();
        bodies.front().q_lab_body = held_turn();
    }

    void let_go(bool, std::vector<Body>& bodies) override {
        Turning::State start;
        start << bodies.front().q_lab_body.coeffs(), rates_;
        const auto slope = [inertia = inertia_](double, const Turning::State& s) {
            const Eigen::Quaterniond q(s.head<4>());
            const Eigen::Vector3d w = s.tail<3>();
            const Eigen::Quaterniond q_dot = q * Eigen::Quaterniond(0.0, w.x(), w.y(), w.z());
            const Eigen::Vector3d momentum = inertia.cwiseProduct(w);
            Turning::State slope;
            slope << 0.5 * q_dot.coeffs(), momentum.cross(w).cwiseQuotient(inertia);
            return slope;
        };
        turning_.emplace(slope, start);
    }

    void follow(double t_s, std::vector<Body>& bodies) override {
        const Turning::State now = turning_->at(t_s);
        Body& box = bodies.front();
        box.q_lab_body = Eigen::Quaterniond(now.head<4>()).normalized();
        box.w_lab = box.q_lab_body * Eigen::Vector3d(now.tail<3>());
    }

private:
    using Turning = FixedGrid<7>;  ///< quaternion x, y, z, w, then the body's own rates
    Eigen::Vector3d rates_;        ///< rad/s
    Eigen::Vector3d inertia_;      ///< about the centre, over m/12, m²
    std::optional<Turning> turning_;
};

}  // namespace

std::span<const ParameterRange> tumbler_ranges() {
    return kRanges;
}

Result<std::unique_ptr<Apparatus>> make_tumbler(const ParameterMap& given) {
    const auto parameters = complete("tumbler", kRanges, given);
    if (!parameters) return tl::unexpected(parameters.error());
    return std::make_unique<Tumbler>(*parameters);
}

}  // namespace kinectlab::simulate
