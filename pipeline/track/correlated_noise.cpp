#include "pipeline/track/correlated_noise.hpp"

#include <algorithm>

namespace kinectlab {
namespace {

constexpr std::uint32_t kBlock = 10;  // px: a Kinect correlates over 9
constexpr double kFading = 0.97;      // of what earlier fits told about the noise

}  // namespace

CorrelatedNoise::CorrelatedNoise(const Pinhole& camera)
    : width_(camera.width), block_columns_(camera.width / static_cast<int>(kBlock) + 1) {
    const int rows = camera.height / static_cast<int>(kBlock) + 1;
    const auto blocks = static_cast<std::size_t>(block_columns_ * rows);
    sum_.resize(blocks);
    squares_.resize(blocks);
}

double CorrelatedNoise::inflation(const ShapePixels& pixels, double sigma, double unknowns) {
    if (pixels.offered == 0) return 1.0;
    const auto width = static_cast<std::uint32_t>(width_);
    const auto columns = static_cast<std::size_t>(block_columns_);
    const auto [top, bottom] = std::minmax_element(pixels.pixel.begin(), pixels.pixel.end());
    const std::size_t first = *top / width / kBlock * columns;
    const std::size_t end = (*bottom / width / kBlock + 1) * columns;
    std::fill(
        sum_.begin() + static_cast<std::ptrdiff_t>(first),
        sum_.begin() + static_cast<std::ptrdiff_t>(end),
        0.0
    );
    std::fill(
        squares_.begin() + static_cast<std::ptrdiff_t>(first),
        squares_.begin() + static_cast<std::ptrdiff_t>(end),
        0.0
    );
    double squares = 0.0, weights = 0.0;
    std::uint32_t row_begin = 0, row_end = 0;  // neighbours in the list share a row
    std::size_t row_blocks = 0;
    for (std::size_t i = 0; i < pixels.offered; ++i) {
        const double weight = pixels.weight[i];
        if (weight <= 0.0) continue;
        const std::uint32_t pixel = pixels.pixel[i];
        if (pixel < row_begin || pixel >= row_end) {
            row_begin = pixel / width * width;
            row_end = row_begin + width;
            row_blocks = pixel / width / kBlock * columns;
        }
        const std::size_t block = row_blocks + (pixel - row_begin) / kBlock;
        const double residual = pixels.residual[i];
        const double error = weight * residual;
        sum_[block] += error;
        squares_[block] += error * error;
        squares += error * residual;
        weights += weight;
    }
    of_blocks_ *= kFading;
    of_pixels_ *= kFading;
    for (std::size_t i = first; i < end; ++i) {
        of_blocks_ += sum_[i] * sum_[i] / (sigma * sigma);
        of_pixels_ += squares_[i] / (sigma * sigma);
    }
    const double chi2 = squares / (sigma * sigma) / std::max(1.0, weights - unknowns);
    const double correlated = of_pixels_ > 0.0 ? std::max(1.0, of_blocks_ / of_pixels_) : 1.0;
    return std::max(1.0, chi2) * correlated;
}

}  // namespace kinectlab
