#include "pipeline/track/thing_outlines.hpp"

#include <algorithm>

namespace kinectlab {

ThingOutlines::ThingOutlines(const RgbdCamera& camera)
    : surface_(camera), depth_unit_m_(camera.depth_unit_m), error_(camera.depth) {
    now_.reserve(static_cast<std::size_t>(camera.depth.width * camera.depth.height));
    before_.reserve(now_.capacity());
}

void ThingOutlines::reset() {
    outlines_ = {};
    next_frame();
}

void ThingOutlines::next_frame() {
    ++frame_;
    std::swap(now_, before_);
    now_.clear();
}

/// The one it had, else that of the thing that was not seen for longest.
ThingOutlines::Outline& ThingOutlines::outline_of(std::uint32_t identity) {
    Outline* longest = &outlines_.front();
    for (auto& outline : outlines_) {
        if (outline.identity == identity) return outline;
        if (outline.frame < longest->frame) longest = &outline;
    }
    *longest = Outline{.identity = identity};
    return *longest;
}

Eigen::Matrix3d ThingOutlines::covariance(
    const Identities& identities,
    std::size_t place,
    const Thing& thing,
    const RgbdFrame& frame,
    std::span<const MovedPixels> moved
) {
    const Eigen::Vector3d centroid = thing.now.centroid();
    const double z = centroid.z(), points = thing.now.points;
    Eigen::Matrix3d covariance = readings_error(centroid, surface_.sigma_z(z) / z, points, points);
    covariance.diagonal().array() += thing.hidden_u * thing.hidden_u;

    const std::size_t begin = now_.size();
    for (std::size_t k = 0; k < moved.size(); ++k) {
        if (identities.owner_of(k) != place) continue;
        for (const auto pixel : moved[k])
            now_.push_back({pixel, 1.0F, static_cast<float>(depth_unit_m_ * frame.depth[pixel])});
    }
    // Where things share a segment, how much of it is whose is the larger part of the error.
    if (now_.size() - begin != static_cast<std::size_t>(thing.now.points)) {
        now_.resize(begin);
        return covariance;
    }
    Outline& outline = outline_of(thing.identity);
    std::span<const OutlineError::Pixel> before;
    if (outline.frame + 1 == frame_)
        before = std::span(before_).subspan(outline.begin, outline.end - outline.begin);
    const auto now = std::span(now_).subspan(begin);
    covariance += error_.covariance(outline.memory, before, now, centroid, points);
    outline.frame = frame_;
    outline.begin = begin;
    outline.end = now_.size();
    return covariance;
}

}  // namespace kinectlab
