#include "pipeline/track/plane_wander.hpp"

#include <algorithm>

namespace kinectlab {
namespace {

constexpr TimeNs kMemory = kNsPerSecond / 2;
constexpr double kExpectedShare = 0.04;    // of the standard deviation of the plane's own points
constexpr double kExpectedCounts = 4.0;    // as many comparisons as the expectation is worth
constexpr double kMostComparisons = 30.0;  // after which the oldest fade

}  // namespace

double PlaneWander::variance(
    TimeNs t, const Eigen::Vector3d& middle_cam, const Eigen::Vector3d& normal_cam, double area_m2
) {
    const bool goes_on = in_a_row_ > 0 && t > seen_at_ && t - seen_at_ <= kMemory;
    in_a_row_ = goes_on ? in_a_row_ + 1 : 1;
    if (in_a_row_ > 2) {
        // Its variance is six times that of one middle.
        const Eigen::Vector3d second = middle_cam - 2.0 * last_ + before_;
        const Eigen::Vector3d along = second - normal_cam * normal_cam.dot(second);
        comparisons_ = std::min(kMostComparisons, comparisons_ + 1.0);
        measured_ += (along.squaredNorm() / 2.0 / 6.0 - measured_) / comparisons_;
    }
    before_ = last_;
    last_ = middle_cam;
    seen_at_ = t;
    // Points spread evenly over a square scatter along its side by a twelfth of its area.
    const double expected = kExpectedShare * kExpectedShare * area_m2 / 12.0;
    return (kExpectedCounts * expected + comparisons_ * measured_) /
           (kExpectedCounts + comparisons_);
}

}  // namespace kinectlab
