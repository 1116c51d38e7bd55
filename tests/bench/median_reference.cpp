#include "pipeline/preprocess/median_reference.hpp"

#include "pipeline/preprocess/change_limits.hpp"
#include "tests/bench/change_truth.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_background.hpp"
#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

constexpr double kThresholdSteps = 5.0;
constexpr double kSpan_s = 3.0;
constexpr int kFrames = 31;        // of that span, ten a second
constexpr double kPhase_s = 0.17;  // between them of the bob's swing: it is nowhere for long

std::vector<float> disparity_of(const LabScene& scene) {
    const DisparityScale scale(scene.camera);
    std::vector<float> steps(scene.frame.depth.size());
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (const auto counts = scene.frame.depth[i]; counts > 0)
            steps[i] = static_cast<float>(scale.steps(counts));
    return steps;
}

}  // namespace

Figures measure_median_reference() {
    const LabScene rest = lab_scene(simulate::NoiseModel::kinect, -1.0, 1);
    const LabScene now = lab_scene(simulate::NoiseModel::kinect, 0.0, 2);
    const int width = rest.camera.depth.width, height = rest.camera.depth.height;
    MedianReference reference(rest.camera, kSpan_s);
    StockBackground background(width, height, kFrames);
    double ms = 0.0, stock_ms = 0.0;
    for (int i = 0; i < kFrames; ++i) {
        const LabScene scene = lab_scene(
            simulate::NoiseModel::kinect, kPhase_s * i, static_cast<std::uint64_t>(10 + i)
        );
        const TimeNs t = i * kNsPerSecond / 10;
        const double start = thread_seconds();
        if (reference.add(scene.frame.depth, t)) reference.update();
        ms += 1e3 * (thread_seconds() - start);
        stock_ms += background.learn(disparity_of(scene));
    }
    ChangeLimits limits(rest.camera, kThresholdSteps);
    limits.rebuild(reference.view());
    ChangeSettings settings;
    settings.width = width;
    settings.height = height;
    settings.product = static_cast<float>(DisparityScale(rest.camera).product);
    std::vector<ChangedRun> runs;
    runs.reserve(most_runs(settings));
    find_changed(now.frame.depth, limits.reach(), settings, runs);
    const double f1 = judge_change(rest, now, mask_of(runs, settings)).f1();

    const std::string name = "reference, the median of seconds in which a bob swings";
    std::optional<double> peer_ms, peer_f1;
    if (StockBackground::is_installed()) {
        peer_ms = stock_ms / kFrames;
        peer_f1 = judge_change(rest, now, background.changed(disparity_of(now)).value).f1();
    }
    const std::string peer = peer_ms ? "OpenCV MOG2" : "";
    return {
        {name + ", time a frame", ms / kFrames, "ms", {}, Better::lower, peer_ms, peer},
        {name + ": F1 of what moved then", f1, "1", peer_f1, Better::higher, peer_f1, peer}};
}

}  // namespace kinectlab::bench
