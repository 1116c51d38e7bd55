#include "pipeline/simulate/incline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/simulate/carried_apparatus.hpp"

namespace kinectlab::simulate {
namespace {

constexpr std::array kRanges = {
    ParameterRange{"incline_deg", 1.0, 30.0, 8.0},
    ParameterRange{"ball_radius_m", 0.02, 0.06, 0.035},
    ParameterRange{"friction", 0.0, 2.0, 0.3},
    ParameterRange{"rolling_drag", 0.0, 0.2, 0.0},
    ParameterRange{"gravity", 0.5, 30.0, 9.81},
};

constexpr double kLength = 1.30;
constexpr double kWidth = 0.30;
constexpr double kThickness = 0.02;
constexpr double kLowEnd = 0.56;  ///< height of its top side there
constexpr double kStopThickness = 0.02;
constexpr double kStopHeight = 0.05;
constexpr double kStart = 0.09;  ///< of the ball's touching point, from the upper end
constexpr double kPost = 0.04;

std::vector<Body> parked(double radius) {
    Body ball{"ball", Sphere{radius}, Material::striped_ball};
    ball.p_lab = {-1.6, 0.0, 1.2};
    return {ball};
}

class Incline final : public CarriedApparatus {
public:
    explicit Incline(const ParameterMap& p)
        : CarriedApparatus(parked(p.at("ball_radius_m"))), radius_(p.at("ball_radius_m")) {
        const double slope = p.at("incline_deg") * std::numbers::pi / 180.0;
        const double g = p.at("gravity");
        const double friction = p.at("friction");
        const double drag = p.at("rolling_drag");
        T_lab_plank_.linear() =
            Eigen::AngleAxisd(slope, Eigen::Vector3d::UnitY()).toRotationMatrix();
        T_lab_plank_.translation() =
            Eigen::Vector3d(0.0, 0.0, kLowEnd + 0.5 * kLength * std::sin(slope));

        const double pull = g * std::sin(slope);
        const double press = g * std::cos(slope);
        const double rolling = 5.0 / 7.0 * (pull - drag * press);
        if (rolling <= 0.0) return;
        if (drag * press + 0.4 * rolling <= friction * press) {
            acceleration_ = rolling;
            spin_up_ = rolling / radius_;
        } else {
            acceleration_ = pull - friction * press;
            spin_up_ = 2.5 * press * std::max(0.0, friction - drag) / radius_;
        }
    }

    Furniture furniture() const override {
        Block plank;
        plank.T_lab_block = T_lab_plank_ * Eigen::Translation3d(0.0, 0.0, -0.5 * kThickness);
        plank.size_m = {kLength, kWidth, kThickness};
        plank.material = Material::plank;
        Block stop;
        stop.T_lab_block =
            T_lab_plank_ *
            Eigen::Translation3d(0.5 * (kLength - kStopThickness), 0.0, 0.5 * kStopHeight);
        stop.size_m = {kStopThickness, kWidth, kStopHeight};
        stop.material = Material::mount;
        Furniture furniture{false, std::nullopt, {plank, stop}};
        for (const double end : {-0.4, 0.4}) {
            const Eigen::Vector3d top = T_lab_plank_ * Eigen::Vector3d(end * kLength, 0.0, -0.04);
            Block post;
            post.T_lab_block.translation() = Eigen::Vector3d(top.x(), 0.0, 0.5 * top.z());
            post.size_m = {kPost, kPost, top.z()};
            furniture.blocks.push_back(post);
        }
        return furniture;
    }

protected:
    double largest_value() const override { return 0.6; }

    void set_up(double value, std::vector<Body>& bodies) const override {
        bodies.front().p_lab =
            T_lab_plank_ * Eigen::Vector3d(kStart + value - 0.5 * kLength, 0.0, radius_);
        bodies.front().q_lab_body = Eigen::Quaterniond::Identity();
    }

    void let_go(bool, std::vector<Body>& bodies) override { start_ = bodies.front(); }

    void follow(double t_s, std::vector<Body>& bodies) override {
        Body& ball = bodies.front();
        const Eigen::Vector3d down = T_lab_plank_.linear().col(0);
        const Eigen::Vector3d across = Eigen::Vector3d::UnitY();
        const double from = (T_lab_plank_.inverse() * start_.p_lab).x();
        const double way = std::max(0.0, 0.5 * kLength - kStopThickness - radius_ - from);
        const double caught_s = std::sqrt(2.0 * way / std::max(acceleration_, 1e-12));
        const bool caught = t_s >= caught_s;
        const double t = std::min(t_s, caught_s);
        ball.p_lab = start_.p_lab + 0.5 * acceleration_ * t * t * down;
        ball.q_lab_body = Eigen::AngleAxisd(0.5 * spin_up_ * t * t, across) * start_.q_lab_body;
        ball.v_lab = caught ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : acceleration_ * t * down;
        ball.w_lab = caught ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : spin_up_ * t * across;
    }

private:
    double radius_;
    Eigen::Isometry3d T_lab_plank_ = Eigen::Isometry3d::Identity();  ///< x down, z off its top side
    double acceleration_ = 0.0;                                      ///< m/s²
    double spin_up_ = 0.0;                                           ///< rad/s²
    Body start_;
};

}  // namespace

std::span<const ParameterRange> incline_ranges() {
    return kRanges;
}

Result<std::unique_ptr<Apparatus>> make_incline(const ParameterMap& given) {
    const auto parameters = complete("incline", kRanges, given);
    if (!parameters) return tl::unexpected(parameters.error());
    return std::make_unique<Incline>(*parameters);
}

}  // namespace kinectlab::simulate
