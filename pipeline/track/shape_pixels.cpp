#include "pipeline/track/shape_pixels.hpp"

#include <algorithm>

namespace kinectlab {
namespace {

constexpr std::size_t kMostPixels = 32768;

}  // namespace

void ShapePixels::gather(
    const DisparityImage& image, const Pinhole& camera, std::span<const std::uint32_t> pixels
) {
    const std::size_t stride = (pixels.size() + kMostPixels - 1) / kMostPixels;
    const auto width = static_cast<std::uint32_t>(camera.width);
    const double per_fx = 1.0 / camera.fx, per_fy = 1.0 / camera.fy;
    for (auto* field : {&x, &y, &s})
        field->resize(pixels.size() + kFitLanes);
    pixel.resize(pixels.size());
    // Neighbours in the list share a row, so that few divisions find it.
    std::uint32_t row_begin = 0, row_end = 0;
    const float* readings = nullptr;
    float ray_y = 0.0F;
    double sum_x = 0.0, sum_y = 0.0, sum_s = 0.0;
    offered = 0;
    for (std::size_t k = 0; k < pixels.size(); k += stride) {
        const std::uint32_t at = pixels[k];
        if (at < row_begin || at >= row_end) {
            const std::uint32_t row = at / width;
            row_begin = row * width;
            row_end = row_begin + width;
            readings = image.row(static_cast<int>(row));
            ray_y = static_cast<float>((row - camera.cy) * per_fy);
        }
        const float steps = readings[at - row_begin];
        if (steps == 0.0F) continue;
        x[offered] = static_cast<float>((at - row_begin - camera.cx) * per_fx);
        y[offered] = ray_y;
        s[offered] = steps;
        pixel[offered] = at;
        sum_x += x[offered];
        sum_y += ray_y;
        sum_s += steps;
        ++offered;
    }
    const auto n = static_cast<double>(std::max<std::size_t>(1, offered));
    mean_x = sum_x / n, mean_y = sum_y / n, mean_s = sum_s / n;
    const std::size_t padded = (offered + kFitLanes - 1) / kFitLanes * kFitLanes;
    pixel.resize(offered);
    for (auto* field : {&x, &y, &s})
        std::fill(
            field->begin() + static_cast<std::ptrdiff_t>(offered),
            field->begin() + static_cast<std::ptrdiff_t>(padded),
            0.0F
        );
    for (auto* field : {&x, &y, &s, &used, &weight, &residual, &height})
        field->resize(padded, 0.0F);
}

double ShapePixels::mean_sigma(const DisparityScale& scale) const {
    return scale.sigma_at(mean_s);
}

Eigen::Vector3d ShapePixels::middle(const DisparityScale& scale) const {
    return Eigen::Vector3d(mean_x, mean_y, 1.0) * scale.metres(mean_s);
}

RoundPixels ShapePixels::round() {
    return {
        x.size(),
        x.data(),
        y.data(),
        s.data(),
        used.data(),
        weight.data(),
        residual.data(),
        height.data()};
}

PlanePixels ShapePixels::flat() {
    return {x.size(), x.data(), y.data(), s.data(), weight.data(), residual.data()};
}

}  // namespace kinectlab
