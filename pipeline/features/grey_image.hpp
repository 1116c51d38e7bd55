#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinectlab {

/// One number a pixel, row-major.
struct GreyImage {
    int width = 0;
    int height = 0;
    std::vector<float> pixels;

    [[nodiscard]] const float* row(int v) const {
        return pixels.data() + static_cast<std::ptrdiff_t>(v) * width;
    }
    [[nodiscard]] float* row(int v) {
        return pixels.data() + static_cast<std::ptrdiff_t>(v) * width;
    }
    void resize(int new_width, int new_height) {
        width = new_width;
        height = new_height;
        pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    }
};

/// A part of a picture; right and bottom are exclusive.
struct ImageRegion {
    int left = 0, top = 0, right = 0, bottom = 0;
    [[nodiscard]] bool empty() const { return right <= left || bottom <= top; }
};

/// Luma (Rec. 601) of a region of a picture with 3 bytes a pixel, 0 to 255. The region lies within.
void grey_of(
    std::span<const std::uint8_t> rgb, int width, const ImageRegion& region, GreyImage& grey
);

/// Gaussian blur, rows and columns one after the other; beyond the edge the last pixel goes on.
/// `scratch` is reused from call to call. `to` may not be `from`.
void blur(const GreyImage& from, float sigma, GreyImage& to, std::vector<float>& scratch);

/// Twice the size by linear interpolation: pixel (u, v) of the picture lies at (2u, 2v).
void doubled(const GreyImage& from, GreyImage& to);

/// Every second pixel of every second row.
void halved(const GreyImage& from, GreyImage& to);

/// The picture of `width` x `height` whose half was taken, between its pixels by polynomials
/// through six: for a blur of 2 px and more in `from` that is exact to some 1e-4 of its contrast.
/// Beyond the edge the last pixel goes on. `scratch` as for blur(). `to` may not be `from`.
void unhalved(
    const GreyImage& from, int width, int height, GreyImage& to, std::vector<float>& scratch
);

}  // namespace kinectlab
