#pragma once

#include "pipeline/core/time.hpp"
#include "pipeline/track/sphere_model.hpp"

namespace kinectlab {

/// Whether a ball has the radius that it is said to have, from the free radius of its first frames:
/// with a wrong one the centre is off by about as much, in each frame alike, and nothing else would
/// tell. A plain value.
class RadiusCheck {
public:
    /// Whether a ball is the one that was looked at a moment ago.
    [[nodiscard]] bool is_of(const Sphere& ball, TimeNs t) const;
    [[nodiscard]] TimeNs last_seen() const { return t_; }
    /// Follows a ball, beginning anew with another one; whether its free radius is asked for.
    [[nodiscard]] bool follow(const Sphere& ball, TimeNs t);
    /// Takes a free radius of the ball that is followed and its standard uncertainty above 0, m.
    /// One that is hardly known (3 %) says nothing.
    void add(double radius_m, double radius_u);
    /// Whether the mean is another radius than the ball's by more than 5 % and 5 u.
    [[nodiscard]] bool is_other(const Sphere& ball) const;

private:
    Eigen::Vector3d place_cam_ = Eigen::Vector3d::Zero();
    TimeNs t_ = 0;
    double sum_ = 0.0, weight_ = 0.0;
    int frames_ = 0;
};

}  // namespace kinectlab
