#pragma once

#include <cstdint>
#include <functional>

#include <Eigen/Core>

namespace kinectlab::simulate {

/// One Runge-Kutta step of fourth order of state' = slope(t, state).
template <int N, class Slope>
[[nodiscard]] Eigen::Vector<double, N> runge_kutta(
    const Slope& slope, double t, const Eigen::Vector<double, N>& s, double dt
) {
    using State = Eigen::Vector<double, N>;
    const State k1 = slope(t, s);
    const State k2 = slope(t + 0.5 * dt, State(s + 0.5 * dt * k1));
    const State k3 = slope(t + 0.5 * dt, State(s + 0.5 * dt * k2));
    const State k4 = slope(t + dt, State(s + dt * k3));
    return s + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

/// A motion integrated on a grid that begins at 0 s, so that it does not depend on how often it is
/// asked for.
template <int N>
class FixedGrid {
public:
    using State = Eigen::Vector<double, N>;
    using Slope = std::function<State(double t_s, const State& state)>;
    static constexpr double kStep = 1.0 / 1024.0;  ///< s

    FixedGrid(Slope slope, const State& start) : slope_(std::move(slope)), state_(start) {}

    /// The state at the last grid point not after `t_s`; times must not decrease.
    const State& advance(double t_s) {
        while (static_cast<double>(steps_ + 1) * kStep <= t_s) {
            state_ = step(kStep);
            ++steps_;
        }
        return state_;
    }

    /// From the last grid point, by at most kStep.
    [[nodiscard]] State step(double dt_s) const {
        return runge_kutta<N>(slope_, grid_s(), state_, dt_s);
    }

    [[nodiscard]] double grid_s() const { return static_cast<double>(steps_) * kStep; }

    /// The state at `t_s`; times must not decrease.
    [[nodiscard]] State at(double t_s) {
        advance(t_s);
        return step(t_s - grid_s());
    }

private:
    Slope slope_;
    State state_;
    std::int64_t steps_ = 0;
};

}  // namespace kinectlab::simulate
