#pragma once

#include <memory>
#include <span>

#include "tests/bench/peer_preprocess.hpp"

namespace kinectlab::bench {

/// OpenCV's mixture of Gaussians (BackgroundSubtractorMOG2 without shadows) on the disparity in
/// steps: the stock way to a background that follows the scene. Pixels without a reading are 0.
class StockBackground {
public:
    /// `history` frames are remembered.
    StockBackground(int width, int height, int history);
    ~StockBackground();
    StockBackground(const StockBackground&) = delete;
    StockBackground& operator=(const StockBackground&) = delete;

    /// Time of learning one frame, ms.
    double learn(std::span<const float> disparity);
    /// 1 = not the background, nothing learned from it.
    [[nodiscard]] Timed<Mask> changed(std::span<const float> disparity);

    /// Without OpenCV's video module nothing is learned or found.
    [[nodiscard]] static bool is_installed();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::bench
