#include "pipeline/preprocess/octree_change.hpp"

#include "tests/bench/lab_scene.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_preprocess.hpp"
#include "tests/bench/preprocess_timing.hpp"

namespace kinectlab::bench {
namespace {

constexpr double kVoxel_m = 0.02;

void compare(
    const std::string& name,
    const Cloud& reference,
    const Cloud& cloud,
    int least_points,
    Figures& figures
) {
    const auto ours_reference = OctreeReference::of(reference, kVoxel_m).value();
    OctreeChange ours;
    const double ms =
        least_ms(7, [&] { ours = ours_reference.changed(cloud, least_points).value(); });
    const StockCloud stock_reference(reference);
    const StockCloud stock_cloud(cloud);
    Timed<Mask> stock = stock_octree_change(stock_reference, stock_cloud, kVoxel_m, least_points);
    for (int round = 0; round < 2; ++round)
        stock.ms = std::min(
            stock.ms, stock_octree_change(stock_reference, stock_cloud, kVoxel_m, least_points).ms
        );
    double differ = 0.0;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        differ += ours.mask[i] != stock.value[i] ? 1.0 : 0.0;
    figures.push_back(
        {"octree change, 20 mm, " + name,
         ms,
         "ms",
         stock.ms / 4.0,
         Better::lower,
         stock.ms,
         "ms PCL"}
    );
    figures.push_back(
        {"octree change, " + name + ": points that differ from PCL",
         differ,
         "of " + std::to_string(ours.count),
         0.0,
         Better::lower,
         std::nullopt,
         ""}
    );
}

}  // namespace

Figures measure_octree_change() {
    Figures figures;
    const LabScene before = lab_scene(simulate::NoiseModel::kinect, -1.0, 1);
    const LabScene after = lab_scene(simulate::NoiseModel::kinect, 0.4, 2);
    compare("simulated frames", before.seen, after.seen, 1, figures);
    compare("at least 5 points a voxel", before.seen, after.seen, 5, figures);
    const auto real = real_clouds(2);
    if (real.size() == 2) compare("real frames", real[0].cloud, real[1].cloud, 1, figures);
    return figures;
}

}  // namespace kinectlab::bench
