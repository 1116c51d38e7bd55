#include <cmath>

#include "pipeline/preprocess/depth_pass.hpp"
#include "tests/bench/lab_scene.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_preprocess.hpp"
#include "tests/bench/preprocess_timing.hpp"

namespace kinectlab::bench {

Figures measure_depth_cut() {
    const LabScene scene = lab_scene(simulate::NoiseModel::kinect, 0.4);
    const DisparityScale scale(scene.camera);
    std::vector<std::uint16_t> near(scene.frame.depth.size());
    DepthPass pass;
    const double ms = least_ms(50, [&] {
        pass =
            pass_nearer_than_wall(scene.frame.depth, scene.camera.depth.width, scale, near).value();
    });

    // Between two counts, so that rounding to float cannot decide.
    const double limit_m = (pass.farthest + 0.5) * scene.camera.depth_unit_m;
    const StockCloud cloud(scene.seen);
    Timed<Mask> stock = stock_pass_through(cloud, limit_m);
    for (int round = 0; round < 9; ++round)
        stock.ms = std::min(stock.ms, stock_pass_through(cloud, limit_m).ms);
    double differ = 0.0, kept = 0.0;
    for (std::size_t i = 0; i < near.size(); ++i) {
        kept += near[i] != 0 ? 1.0 : 0.0;
        differ += (near[i] != 0) != (stock.value[i] != 0) ? 1.0 : 0.0;
    }
    return {
        {"depth cut with its histogram",
         ms,
         "ms",
         stock.ms / 15.0,
         Better::lower,
         stock.ms,
         "ms PCL PassThrough, limit given"},
        {"depth cut: pixels that differ from PCL at that limit",
         differ,
         "of " + std::to_string(static_cast<long>(kept)),
         0.0,
         Better::lower,
         std::nullopt,
         ""},
        {"depth cut: where, wall at 3.2 m",
         pass.cut ? limit_m : std::nan(""),
         "m",
         std::nullopt,
         Better::lower,
         std::nullopt,
         ""},
    };
}

}  // namespace kinectlab::bench
