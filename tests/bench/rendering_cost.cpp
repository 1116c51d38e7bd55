#include <stdexcept>

#include "pipeline/simulate/simulate_run.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {

// Depth, colour and the Kinect's noise: what a simulated rig of the server renders. simulate_run
// works in the caller's thread alone, so its CPU time is the whole cost.
Figures measure_rendering() {
    simulate::RunSettings run;
    run.rig.with_colour = true;
    run.seconds = 10.0;
    const double start = thread_seconds();
    const auto done = simulate::simulate_run(
        run, [](const RgbdFrame&, const simulate::Truth&) -> Result<void> { return {}; }
    );
    const double seconds = thread_seconds() - start;
    if (!done) throw std::runtime_error(to_text(done.error()));
    const double frames = static_cast<double>(done->frames);
    constexpr double kFrameRateHz = 30.0;
    return {
        {"rendering a rig, depth and colour, per frame",
         1e3 * seconds / frames,
         "ms",
         {},
         Better::lower,
         {},
         {}},
        {"rendering a rig at 30 Hz, share of one core",
         kFrameRateHz * seconds / frames,
         "1",
         0.4,
         Better::lower,
         {},
         {}},
    };
}

}  // namespace kinectlab::bench
