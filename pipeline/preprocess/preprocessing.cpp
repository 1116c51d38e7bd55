#include "pipeline/preprocess/preprocessing.hpp"

namespace kinectlab {
namespace {

ChangeSettings change_settings(const RgbdCamera& camera) {
    ChangeSettings settings;
    settings.width = camera.depth.width;
    settings.height = camera.depth.height;
    settings.product = static_cast<float>(DisparityScale(camera).product);
    return settings;
}

}  // namespace

Preprocessing::Preprocessing(const RgbdCamera& camera, const PreprocessSettings& settings)
    : reference_method_(settings.reference.method),
      cleaner_(camera, settings),
      reference_(camera),
      median_rules_(settings.reference.method != ReferenceMethod::scene),
      limits_(camera, settings.change.threshold_steps, settings.depth_cut),
      change_(change_settings(camera)),
      segmenter_(change_, settings.min_segment_points) {
    if (median_rules_) median_.emplace(camera, settings.reference.seconds);
    if (settings.change.method == ChangeMethod::octree) voxels_.emplace(camera, settings.change);
    runs_.reserve(most_runs(change_));
}

SceneView Preprocessing::scene() const {
    return median_rules_ ? median_->view() : reference_.view();
}

void Preprocessing::learn(const RgbdFrame& frame) {
    if (median_rules_) {
        update_median(frame);
    } else {
        reference_.learn(frame.depth);
        scene_is_new_ = true;
    }
    ++learned_;
}

void Preprocessing::uncover(const RgbdFrame& frame) {
    if (reference_method_ != ReferenceMethod::scene) return;
    reference_.uncover(frame.depth);
    scene_is_new_ = true;
}

void Preprocessing::update_median(const RgbdFrame& frame) {
    if (median_->add(frame.depth, frame.t)) {
        median_->update();
        scene_is_new_ = true;
    }
    if (reference_method_ != ReferenceMethod::median || !median_->complete(frame.t)) return;
    reference_.assign(median_->view());
    median_rules_ = false;
}

Result<std::span<const std::uint16_t>> Preprocessing::reach_of(const RgbdFrame& clean) {
    if (scene_is_new_) {
        limits_.rebuild(scene());
        if (voxels_)
            if (auto ok = voxels_->set_reference(scene()); !ok) return tl::unexpected(ok.error());
    }
    scene_is_new_ = false;
    if (voxels_) return voxels_->reach(clean.depth, limits_.reach());
    return limits_.reach();
}

Result<std::span<const PixelList>> Preprocessing::moved(const RgbdFrame& clean) {
    const auto reach = reach_of(clean);
    if (!reach) return tl::unexpected(reach.error());
    find_changed(clean.depth, *reach, change_, runs_);
    return segmenter_.segment(clean.depth, limits_.trusted(), runs_);
}

void Preprocessing::follow(const RgbdFrame& frame) {
    if (median_rules_) return update_median(frame);
    const RowRange followed = reference_.follow(frame.depth);
    limits_.update(reference_.view(), followed);
    // Voxels are made anew once the reference came by all of the picture.
    if (!voxels_ || ++followed_ < ReferenceScene::kStrips) return;
    followed_ = 0;
    scene_is_new_ = true;
}

void Preprocessing::reset() {
    reference_.reset();
    if (median_) median_->reset();
    median_rules_ = median_.has_value();
    scene_is_new_ = true;
    learned_ = 0;
}

}  // namespace kinectlab
