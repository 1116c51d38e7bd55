#include <algorithm>

#include "pipeline/preprocess/change.hpp"
#include "pipeline/preprocess/change_limits.hpp"
#include "pipeline/preprocess/reference.hpp"
#include "tests/bench/change_truth.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_preprocess.hpp"
#include "tests/bench/preprocess_timing.hpp"

namespace kinectlab::bench {
namespace {

constexpr double kThresholdSteps = 5.0;
constexpr int kReferenceFrames = 30;

}  // namespace

Figures measure_organised_change() {
    const LabScene before = lab_scene(simulate::NoiseModel::kinect, -1.0, 1);
    const LabScene now = lab_scene(simulate::NoiseModel::kinect, 0.0, 2);
    ReferenceScene reference(before.camera);
    for (std::uint64_t seed = 1; seed <= kReferenceFrames; ++seed)
        reference.learn(lab_scene(simulate::NoiseModel::kinect, -1.0, seed).frame.depth);
    ChangeLimits limits(before.camera, kThresholdSteps);
    limits.rebuild(reference.view());
    ChangeSettings settings;
    settings.width = before.camera.depth.width;
    settings.height = before.camera.depth.height;
    settings.product = static_cast<float>(DisparityScale(before.camera).product);
    std::vector<ChangedRun> runs;
    runs.reserve(most_runs(settings));
    find_changed(now.frame.depth, limits.reach(), settings, runs);
    const ChangeCounts ours = judge_change(before, now, mask_of(runs, settings));
    const double ms = least_ms(50, [&] {
        find_changed(now.frame.depth, limits.reach(), settings, runs);
        limits.update(reference.view(), reference.follow(now.frame.depth));
    });

    const StockCloud stock_reference(before.seen), stock_now(now.seen);
    Timed<Mask> best;
    ChangeCounts stock;
    double stock_ms = std::numeric_limits<double>::infinity();
    for (const int least : {1, 2, 4, 8, 16}) {
        auto found = stock_octree_change(stock_reference, stock_now, 0.02, least);
        stock_ms = std::min(stock_ms, found.ms);
        if (const ChangeCounts counts = judge_change(before, now, found.value);
            best.value.empty() || counts.f1() > stock.f1()) {
            stock = counts;
            best = std::move(found);
        }
    }
    return {
        {"change in the image grid, with the rolling reference",
         ms,
         "ms",
         stock_ms / 50.0,
         Better::lower,
         stock_ms,
         "ms PCL octree"},
        {"change in the image grid: F1",
         ours.f1(),
         "",
         stock.f1(),
         Better::higher,
         stock.f1(),
         "PCL octree, its best least points"},
    };
}

}  // namespace kinectlab::bench
