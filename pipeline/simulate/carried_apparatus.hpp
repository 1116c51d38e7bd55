#pragma once

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

/// An apparatus whose bodies are kept beside the picture. Displace: an arm brings them to their
/// start in 2 s; stop: it takes them out of the picture again in 2.8 s. So the scene without them
/// can be learned whenever it is at rest. An arm on its way cannot be held up: hold and release
/// change nothing then. What is held in mid-motion has lost its speed.
class CarriedApparatus : public Apparatus {
public:
    [[nodiscard]] Result<void> apply(const Command& command) final;
    void advance_to(double t_s) final;
    [[nodiscard]] double t_s() const final { return t_s_; }
    [[nodiscard]] Motion motion() const final { return motion_; }
    [[nodiscard]] double value() const override { return value_; }
    [[nodiscard]] std::vector<Body> bodies() const final { return bodies_; }

protected:
    /// The bodies where they are kept; advance_to() moves these.
    explicit CarriedApparatus(std::vector<Body> parked);

    /// How far displace goes to either side; 0 where it only knows the start.
    [[nodiscard]] virtual double least_value() const { return 0.0; }
    [[nodiscard]] virtual double largest_value() const { return 0.0; }

    /// Puts the bodies where they are held when displaced by so much.
    virtual void set_up(double value, std::vector<Body>& bodies) const = 0;

    /// The bodies are let go where they are; `anew` after displace, else after they were held in
    /// mid-motion. May change their speeds.
    virtual void let_go(bool anew, std::vector<Body>& bodies) = 0;

    /// Where they are so long after that; times do not decrease.
    virtual void follow(double t_s, std::vector<Body>& bodies) = 0;

private:
    void carry(Motion motion, std::vector<Body> to, double stiffness);
    void hold_here(Motion motion);

    const std::vector<Body> parked_;
    std::vector<Body> bodies_;
    std::vector<Body> from_, to_;  ///< of the arms' way
    double stiffness_ = 1.0;       ///< 1/s
    Motion motion_ = Motion::at_rest;
    bool held_anew_ = true;
    double value_ = 0.0;
    double t_s_ = 0.0;
    double motion_start_s_ = 0.0;
};

}  // namespace kinectlab::simulate
