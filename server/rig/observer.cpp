#include "server/rig/observer.hpp"

#include "pipeline/motion/motion.hpp"

namespace kinectlab::rig {
namespace {

/// What a velocity is made of; longer would cost time and not make the newest one better.
constexpr TimeNs kMemory = 2 * kNsPerSecond / 5;

}  // namespace

Eigen::Isometry3d level_camera() {
    Eigen::Isometry3d T_lab_cam = Eigen::Isometry3d::Identity();
    // Columns: the camera's x, y and z axes in the lab.
    T_lab_cam.linear().col(0) = Eigen::Vector3d::UnitX();
    T_lab_cam.linear().col(1) = -Eigen::Vector3d::UnitZ();
    T_lab_cam.linear().col(2) = Eigen::Vector3d::UnitY();
    return T_lab_cam;
}

Result<Observer> Observer::create(const SourceInfo& source, const TrackingPlan& plan) {
    auto chain = Chain::create(
        {.camera = source.camera, .objects = plan.objects, .preprocess = plan.preprocess}
    );
    if (!chain) return tl::unexpected(chain.error());
    return Observer(std::move(*chain), plan.objects, source);
}

Observer::Observer(Chain chain, std::vector<ObjectSpec> objects, const SourceInfo& source)
    : chain_(std::move(chain)),
      objects_(std::move(objects)),
      T_lab_cam_(source.T_lab_cam.value_or(level_camera())),
      frame_period_s_(1.0 / source.frame_rate_hz) {}

Result<std::span<const Observed>> Observer::track(const RgbdFrame& frame) {
    const auto samples = chain_.track(frame);
    if (!samples) return tl::unexpected(samples.error());
    observed_.clear();
    for (const TrackSample& sample : *samples) {
        if (sample.object >= objects_.size()) continue;
        auto& recent = recent_[{sample.object, sample.identity}];
        recent.push_back(sample);
        while (recent.front().t < sample.t - kMemory)
            recent.pop_front();
        const std::vector<TrackSample> window(recent.begin(), recent.end());
        std::string name = objects_[sample.object].name;
        if (sample.identity > 0) name.append("-").append(std::to_string(sample.identity));
        Trajectory trajectory =
            to_trajectory(name, window, T_lab_cam_, {.frame_period_s = frame_period_s_});
        observed_.push_back({name, sample, trajectory.samples.back()});
    }
    std::erase_if(recent_, [&](const auto& thing) {
        return thing.second.empty() || thing.second.back().t < frame.t - kMemory;
    });
    return std::span<const Observed>(observed_);
}

}  // namespace kinectlab::rig
