#include "pipeline/track/shape_pixels.hpp"

#include <algorithm>
#include <numeric>

namespace kinectlab {
namespace {

constexpr std::size_t kMostPixels = 32768;

}  // namespace

void ShapePixels::gather(
    const DisparityImage& image, const Pinhole& camera, std::span<const std::uint32_t> pixels
) {
    for (auto* field : {&x, &y, &s})
        field->clear();
    pixel.clear();
    const std::size_t stride = (pixels.size() + kMostPixels - 1) / kMostPixels;
    const auto width = static_cast<std::uint32_t>(camera.width);
    const double per_fx = 1.0 / camera.fx, per_fy = 1.0 / camera.fy;
    for (std::size_t k = 0; k < pixels.size(); k += stride) {
        const float steps = image.at(pixels[k]);
        if (steps == 0.0F) continue;
        x.push_back(static_cast<float>((pixels[k] % width - camera.cx) * per_fx));
        y.push_back(static_cast<float>((pixels[k] / width - camera.cy) * per_fy));
        s.push_back(steps);
        pixel.push_back(pixels[k]);
    }
    offered = s.size();
    const double n = static_cast<double>(std::max<std::size_t>(1, offered));
    mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
    mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
    mean_s = std::accumulate(s.begin(), s.end(), 0.0) / n;
    const std::size_t padded = (offered + kFitLanes - 1) / kFitLanes * kFitLanes;
    for (auto* field : {&x, &y, &s, &used, &weight, &residual, &height})
        field->resize(padded, 0.0F);
    for (auto& field : slope)
        field.resize(padded, 0.0F);
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
        height.data(),
        {slope[0].data(),
         slope[1].data(),
         slope[2].data(),
         slope[3].data(),
         slope[4].data(),
         slope[5].data()}};
}

PlanePixels ShapePixels::flat() {
    return {x.size(), x.data(), y.data(), s.data(), weight.data(), residual.data()};
}

NormalSums ShapePixels::sums() const {
    return sum_equations(
        {slope[0].data(),
         slope[1].data(),
         slope[2].data(),
         slope[3].data(),
         slope[4].data(),
         slope[5].data()},
        weight.data(),
        residual.data(),
        x.size()
    );
}

}  // namespace kinectlab
