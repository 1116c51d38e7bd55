#include <cmath>
#include <cstring>
#include <optional>

#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_stock_chain.hpp"
#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

struct Timing {
    double mean_ms = 0.0;
    double rms_mm = 0.0;
    double found_share = 0.0;
};

/// Time and error of `find` (frame → centre, if any) over frames, again and again.
template <class Find>
Timing time_over(const SwingFrames& frames, std::size_t count, int rounds, Find find) {
    double squares = 0.0, found = 0.0, seconds = 0.0, all = 0.0;
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < frames.swing.size(); i += frames.swing.size() / count) {
            const double start = thread_seconds();
            const std::optional<Eigen::Vector3d> centre = find(frames.swing[i]);
            seconds += thread_seconds() - start;
            all += 1.0;
            if (!centre) continue;
            found += 1.0;
            squares += (*centre - frames.centre_cam[i]).squaredNorm();
        }
    }
    return {1e3 * seconds / all, 1e3 * std::sqrt(squares / found), found / all};
}

Timing time_chain(const SwingFrames& frames) {
    Chain chain = chain_for(frames);
    (void)chain.track(frames.swing.front());  // the change limits are made at the first frame
    return time_over(
        frames,
        frames.swing.size(),
        8,
        [&](const RgbdFrame& frame) -> std::optional<Eigen::Vector3d> {
            const TrackSample bob = chain.track(frame).value().front();
            if (bob.status != TrackStatus::tracked) return std::nullopt;
            return bob.p_cam;
        }
    );
}

double time_copy_ms(const SwingFrames& frames) {
    std::vector<std::uint16_t> copy(frames.swing.front().depth.size());
    const auto copied = time_over(
        frames,
        frames.swing.size(),
        8,
        [&](const RgbdFrame& frame) -> std::optional<Eigen::Vector3d> {
            std::memcpy(copy.data(), frame.depth.data(), copy.size() * sizeof(std::uint16_t));
            asm volatile("" ::"r"(copy.data()) : "memory");
            return std::nullopt;
        }
    );
    return copied.mean_ms;
}

Timing time_stock(const SwingFrames& frames) {
    StockChain stock({frames.camera, 3.0, frames.radius_m}, frames.before.back());
    return time_over(frames, 12, 1, [&](const RgbdFrame& frame) { return stock.track(frame); });
}

}  // namespace

Figures measure_frame_to_pose() {
    const SwingFrames frames = simulated_swing({});
    const Timing ours = time_chain(frames);
    const double copy_ms = time_copy_ms(frames);
    const Timing stock = time_stock(frames);
    const std::string peer = "PCL stock chain";
    return {
        {"depth frame to pose, mean, one thread",
         ours.mean_ms,
         "ms",
         1.0,
         Better::lower,
         stock.mean_ms,
         peer},
        {"depth frame to pose, times faster than the stock chain",
         stock.mean_ms / ours.mean_ms,
         "1",
         100.0,
         Better::higher,
         {},
         {}},
        {"depth frame to pose, in copies of the depth frame",
         ours.mean_ms / copy_ms,
         "1",
         {},
         Better::lower,
         stock.mean_ms / copy_ms,
         peer},
        {"depth frame to pose, RMS error of the centre",
         ours.rms_mm,
         "mm",
         {},
         Better::lower,
         stock.rms_mm,
         peer},
        {"depth frame to pose, frames with a pose",
         ours.found_share,
         "1",
         0.99,
         Better::higher,
         stock.found_share,
         peer},
    };
}

}  // namespace kinectlab::bench
