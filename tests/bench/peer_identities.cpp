#include "tests/bench/peer_identities.hpp"

#include <algorithm>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace kinectlab::bench {
namespace {

constexpr double kNearer_m = 0.1;  // than the background: well above the noise
constexpr int kFewestPixels = 60;
constexpr double kNearest_m = 0.3;  // farther is another thing
constexpr int kPatience = 60;       // frames

}  // namespace

OpenCvNearestNames::OpenCvNearestNames(
    const RgbdCamera& camera, std::vector<std::uint16_t> background
)
    : camera_(camera), background_(std::move(background)) {
    cv::setNumThreads(1);
}

std::vector<Eigen::Vector3d> OpenCvNearestNames::components(const RgbdFrame& frame) const {
    const Pinhole& k = camera_.depth;
    const double nearer = kNearer_m / camera_.depth_unit_m;
    cv::Mat mask(k.height, k.width, CV_8UC1, cv::Scalar(0)), labels, stats, centroids;
    for (std::size_t i = 0; i < frame.depth.size(); ++i)
        if (frame.depth[i] != 0 && frame.depth[i] + nearer < background_[i]) mask.data[i] = 255;
    cv::morphologyEx(mask, mask, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8UC1));
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 4);
    std::vector<Eigen::Vector3d> sums(static_cast<std::size_t>(count), Eigen::Vector3d::Zero());
    for (int v = 0; v < k.height; ++v)
        for (int u = 0; u < k.width; ++u)
            if (const int label = labels.at<int>(v, u); label > 0)
                sums[static_cast<std::size_t>(label)] +=
                    k.ray(u, v) *
                    (camera_.depth_unit_m * frame.depth[static_cast<std::size_t>(v * k.width + u)]);
    std::vector<Eigen::Vector3d> places;
    for (int label = 1; label < count; ++label) {
        const int area = stats.at<int>(label, cv::CC_STAT_AREA);
        if (area >= kFewestPixels)
            places.emplace_back(sums[static_cast<std::size_t>(label)] / area);
    }
    return places;
}

std::span<const OpenCvNearestNames::Named> OpenCvNearestNames::follow(const RgbdFrame& frame) {
    seen_.clear();
    auto places = components(frame);
    for (auto& known : known_)
        ++known.unseen;
    // The nearest pair first.
    while (!places.empty()) {
        double nearest = kNearest_m;
        std::size_t place = 0;
        Known* owner = nullptr;
        for (auto& known : known_)
            for (std::size_t i = 0; i < places.size() && known.unseen > 0; ++i) {
                const double off = (known.thing.p_cam - places[i]).norm();
                if (off >= nearest) continue;
                nearest = off;
                place = i;
                owner = &known;
            }
        if (owner == nullptr) break;
        owner->thing.p_cam = places[place];
        owner->unseen = 0;
        seen_.push_back(owner->thing);
        places.erase(places.begin() + static_cast<std::ptrdiff_t>(place));
    }
    for (const auto& place : places) {
        known_.push_back({{next_++, place}, 0});
        seen_.push_back(known_.back().thing);
    }
    std::erase_if(known_, [](const Known& known) { return known.unseen > kPatience; });
    return seen_;
}

}  // namespace kinectlab::bench
