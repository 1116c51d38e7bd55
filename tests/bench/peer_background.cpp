#include "tests/bench/peer_background.hpp"

#include "tests/bench/swing_frames.hpp"

#ifdef KINECTLAB_VIDEO

#include <opencv2/video/background_segm.hpp>

namespace kinectlab::bench {

struct StockBackground::State {
    int width, height;
    cv::Ptr<cv::BackgroundSubtractorMOG2> background;
    cv::Mat foreground;

    double apply(std::span<const float> disparity, double rate) {
        // MOG2 takes floating point as grey values, of which it has 256; its thresholds are in
        // those.
        const cv::Mat picture(height, width, CV_32F, const_cast<float*>(disparity.data()));
        const double start = thread_seconds();
        background->apply(picture, foreground, rate);
        return 1e3 * (thread_seconds() - start);
    }
};

StockBackground::StockBackground(int width, int height, int history)
    : state_(std::make_unique<State>(State{
          width, height, cv::createBackgroundSubtractorMOG2(history, 16.0, false), {}})) {
    state_->background->setBackgroundRatio(0.5);  // what is there half of the time, as the median
    cv::setNumThreads(1);
}

StockBackground::~StockBackground() = default;

double StockBackground::learn(std::span<const float> disparity) {
    return state_->apply(disparity, -1.0);
}

Timed<Mask> StockBackground::changed(std::span<const float> disparity) {
    Timed<Mask> found;
    found.ms = state_->apply(disparity, 0.0);
    found.value.resize(disparity.size());
    for (std::size_t i = 0; i < disparity.size(); ++i)
        found.value[i] = state_->foreground.data[i] != 0 && disparity[i] > 0.0F ? 1 : 0;
    return found;
}

bool StockBackground::is_installed() {
    return true;
}

}  // namespace kinectlab::bench

#else

namespace kinectlab::bench {

struct StockBackground::State {};
StockBackground::StockBackground(int, int, int) {}
StockBackground::~StockBackground() = default;
double StockBackground::learn(std::span<const float>) {
    return 0.0;
}
Timed<Mask> StockBackground::changed(std::span<const float> disparity) {
    return {Mask(disparity.size(), 0), 0.0};
}
bool StockBackground::is_installed() {
    return false;
}

}  // namespace kinectlab::bench

#endif
