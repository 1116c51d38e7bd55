#include "pipeline/track/shape_memory.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr double kSlack_m = 0.1;
constexpr double kFastest_m_s = 8.0;        // thrown, before its velocity is known
constexpr double kFastestChange_m_s = 4.0;  // of what is followed
constexpr double kMostUnsure_m = 0.2;       // what an unsure place adds
constexpr double kSigmas = 3.0;
constexpr double kSizeTolerance = 0.25;  // as part of the size
constexpr double kSizeSigmas = 2.0;
constexpr double kLeastSizeU = 0.01;  // as part of the size: fits share their errors
constexpr int kLearned = 3;           // sightings; one may have been another thing

}  // namespace

bool ShapeMemory::is_fresh(TimeNs t, TimeNs duration) const {
    const TimeNs age = t - place_.seen_at();  // below zero where a recording starts again
    return in_a_row_ > 0 && age >= 0 && age <= duration;
}

double ShapeMemory::reach(TimeNs t) const {
    const double speed = in_a_row_ > 1 ? kFastestChange_m_s : kFastest_m_s;
    return kSlack_m + speed * to_seconds(t - place_.seen_at());
}

double ShapeMemory::distance(TimeNs t, const Eigen::Vector3d& p_cam) const {
    const double from_last = (p_cam - place_.at(place_.seen_at())).norm();
    return std::min(from_last, (p_cam - place_.at(t)).norm());
}

bool ShapeMemory::is_alike(const ShapeSighting& seen) const {
    const bool known = sizes_ >= kLearned || (sizes_ > 0 && is_fresh(seen.t));
    if (!known || seen.size <= 0.0) return true;
    const double u = std::hypot(seen.size_u, 1.0 / std::sqrt(weight_));
    return std::abs(seen.size - size_) <= kSizeTolerance * size_ + kSizeSigmas * u;
}

bool ShapeMemory::may_be(const ShapeSighting& seen) const {
    if (!is_alike(seen)) return false;
    if (!is_fresh(seen.t)) return true;
    const double unsure = std::min(kMostUnsure_m, kSigmas * std::sqrt(seen.variance));
    return distance(seen.t, seen.p_cam) <= reach(seen.t) + unsure;
}

void ShapeMemory::observe(const ShapeSighting& seen, TimeNs duration) {
    if (is_fresh(seen.t, duration)) {
        place_.observe(seen.t, seen.p_cam, seen.variance);
        ++in_a_row_;
    } else {
        place_ = PredictedPoint(seen.t, seen.p_cam, seen.variance);
        in_a_row_ = 1;
        if (sizes_ < kLearned) sizes_ = 0, weight_ = 0.0;
    }
    if (seen.size <= 0.0) return;
    const double u = std::max(seen.size_u, kLeastSizeU * seen.size);
    const double weight = 1.0 / (u * u);
    weight_ += weight;
    size_ = sizes_ == 0 ? seen.size : size_ + weight / weight_ * (seen.size - size_);
    ++sizes_;
}

}  // namespace kinectlab
