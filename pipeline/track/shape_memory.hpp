#pragma once

#include "pipeline/track/predicted_point.hpp"

namespace kinectlab {

/// Where a shape was seen and how large it was.
struct ShapeSighting {
    TimeNs t = 0;
    Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();
    double variance = 0.0;  ///< of the place along an axis, m²
    double size = 0.0;      ///< a free radius or angle; 0 where there is none
    double size_u = 0.0;
};

/// What is known of one object from the frames in which it was seen, so that another thing is not
/// taken for it: for a second it can be only where it could have moved to, and a size that was
/// learned holds until it is forgotten. A plain value.
class ShapeMemory {
public:
    static constexpr TimeNs kDuration = kNsPerSecond;  ///< of a place

    [[nodiscard]] bool is_fresh(TimeNs t, TimeNs duration = kDuration) const;

    /// Whether the object can be this.
    [[nodiscard]] bool may_be(const ShapeSighting& seen) const;
    /// Whether it has the object's size, wherever it is; yes while that is not known.
    [[nodiscard]] bool is_alike(const ShapeSighting& seen) const;
    /// How far from its last or its expected place the object can be by now, m.
    [[nodiscard]] double reach(TimeNs t) const;
    /// From the nearer of those two places, m.
    [[nodiscard]] double distance(TimeNs t, const Eigen::Vector3d& p_cam) const;

    /// Starts anew from there where the last place is older than `duration`.
    void observe(const ShapeSighting& seen, TimeNs duration = kDuration);
    void forget() { *this = {}; }

    [[nodiscard]] const PredictedPoint& place() const { return place_; }

private:
    PredictedPoint place_;
    int in_a_row_ = 0;  // sightings since it was found; 0: never seen
    int sizes_ = 0;     // that the mean is made of
    double size_ = 0.0, weight_ = 0.0;
};

}  // namespace kinectlab
