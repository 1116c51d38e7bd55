#include "pipeline/simulate/depth_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace kinectlab::simulate {
namespace {

constexpr float kStepsAtInfinity = static_cast<float>(3.0 / 2.85e-3);
constexpr float kStepsPerInverse = static_cast<float>(1.0 / 2.85e-3);
constexpr float kSigma = 0.5F;                     ///< disparity steps, before rounding
constexpr int kDisparities = 1050;                 ///< 1/Z reaches 0 at 1052.6
constexpr double kProjectorBaseline = 0.075;       ///< m
constexpr float kLateralSigma = 0.6F;              ///< px
constexpr int kMargin = 4;                         ///< px, more than any sideways look
constexpr float kEdge = 12.0F / kStepsPerInverse;  ///< 1/m between two sides of an edge
constexpr int kLostAtEdge = 90;                    ///< of 256
constexpr int kBlindColumns = 8;
constexpr int kSpots = 40;        ///< of 2x2 pixels, in a frame
constexpr double kCoupled = 0.7;  ///< share of the variance that neighbours have in common
constexpr std::array<float, 5> kPyramid = {1, 2, 3, 2, 1};
constexpr double kPyramidNorm = 4.358898943540674;  ///< sqrt(19), so that variance is kept

enum Purpose : std::uint32_t { white, coupled, sideways, loss, spots, string_patch };

std::vector<std::uint16_t> millimetres_of_disparity(bool kinect) {
    std::vector<std::uint16_t> table(kDisparities + 1, 0);
    for (int d = 1; d <= kDisparities; ++d) {
        const double z = 1.0 / (3.0 - 2.85e-3 * d);
        if (kinect && (z < 0.45 || z > 9.5)) continue;
        table[d] = static_cast<std::uint16_t>(std::lround(1000.0 * z));
    }
    return table;
}

int to_step(float disparity) {
    return static_cast<int>(std::clamp(disparity + 0.5F, 0.0F, static_cast<float>(kDisparities)));
}

/// Of 256: none up to 65° from the normal, all at 90°.
const std::array<std::uint8_t, 256> kMissingAtGrazing = [] {
    std::array<std::uint8_t, 256> missing{};
    for (std::size_t grazing = 0; grazing < missing.size(); ++grazing) {
        const double degrees = static_cast<double>(grazing) * 90.0 / 255.0;
        const double share = std::clamp((degrees - 65.0) / 25.0, 0.0, 1.0);
        missing[grazing] = static_cast<std::uint8_t>(255.0 * share * share);
    }
    return missing;
}();

std::vector<float> smoothed_gaussians() {
    const auto& table = gaussian_table();
    std::vector<float> smooth(table.size());
    for (std::size_t i = 0; i < smooth.size(); ++i) {
        float sum = 0.0F;
        for (std::size_t k = 0; k < kPyramid.size(); ++k)
            sum += kPyramid[k] * table[(i + k) % kTablePlaces];
        smooth[i] = sum / static_cast<float>(kPyramidNorm);
    }
    return smooth;
}

std::vector<std::int32_t> sideways_looks(int stride) {
    const auto& table = gaussian_table();
    const auto shift = [&table](std::size_t i) {
        const auto pixels = static_cast<std::int32_t>(std::lround(kLateralSigma * table[i]));
        return std::clamp(pixels, -kMargin, kMargin);
    };
    std::vector<std::int32_t> looks(table.size());
    for (std::size_t i = 0; i < looks.size(); ++i)
        looks[i] = shift(i % kTablePlaces) + stride * shift((i + kTablePlaces / 2) % kTablePlaces);
    return looks;
}

}  // namespace

Result<NoiseModel> noise_model_named(std::string_view name) {
    if (name == "none") return NoiseModel::none;
    if (name == "khoshelham") return NoiseModel::khoshelham;
    if (name == "kinect") return NoiseModel::kinect;
    return fail(
        ErrorCode::invalid_argument,
        "noise",
        "is \"" + std::string(name) + "\"",
        "give none, khoshelham or kinect"
    );
}

DepthNoise::DepthNoise(NoiseModel model, const Pinhole& camera, const ExactDepth& room)
    : model_(model),
      width_(camera.width),
      height_(camera.height),
      shadow_px_m_(kProjectorBaseline * camera.fx),
      mm_(millimetres_of_disparity(model == NoiseModel::kinect)),
      stride_(camera.width + 2 * kMargin) {
    if (model != NoiseModel::kinect) return;
    lit_.resize(static_cast<std::size_t>(stride_) * (height_ + 2 * kMargin));
    missing_.resize(static_cast<std::size_t>(width_) * height_);
    aside_ = sideways_looks(stride_);
    smooth_ = smoothed_gaussians();
    looked_.resize(width_);
    noise_.resize(width_);
    look_at(room, 0, height_);
}

void DepthNoise::apply(
    const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
) {
    depth_mm.resize(exact.inverse_depth.size());
    if (model_ == NoiseModel::none) apply_none(exact, depth_mm);
    if (model_ == NoiseModel::khoshelham) apply_khoshelham(exact, random, depth_mm);
    if (model_ == NoiseModel::kinect) apply_kinect(exact, random, depth_mm);
}

void DepthNoise::apply_none(const ExactDepth& exact, std::vector<std::uint16_t>& depth_mm) const {
    const auto to_mm = [](float inverse) {
        const float mm = inverse > 0.0F ? 1000.0F / inverse + 0.5F : 0.0F;
        return static_cast<std::uint16_t>(mm < 65535.0F ? static_cast<int>(mm) : 0);
    };
    std::transform(exact.inverse_depth.begin(), exact.inverse_depth.end(), depth_mm.begin(), to_mm);
    for (const StringPixel& pixel : exact.string)
        depth_mm[static_cast<std::size_t>(pixel.v) * width_ + pixel.u] = to_mm(pixel.inverse_depth);
}

void DepthNoise::apply_khoshelham(
    const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
) const {
    const auto reading = [this](float inverse, float gauss) {
        const int step = to_step(kStepsAtInfinity - kStepsPerInverse * inverse + kSigma * gauss);
        return inverse > 0.0F ? mm_[step] : std::uint16_t{0};
    };
    const auto noise_of_row = [&random](int v) {
        return gaussian_table().data() + place(random.draw(white, static_cast<std::uint32_t>(v)));
    };
    for (int v = 0; v < height_; ++v) {
        const float* noise = noise_of_row(v);
        const std::size_t begin = static_cast<std::size_t>(v) * width_;
        for (int u = 0; u < width_; ++u)
            depth_mm[begin + u] = reading(exact.inverse_depth[begin + u], noise[u]);
    }
    for (const StringPixel& pixel : exact.string)
        depth_mm[static_cast<std::size_t>(pixel.v) * width_ + pixel.u] =
            reading(pixel.inverse_depth, noise_of_row(pixel.v)[pixel.u]);
}

void DepthNoise::apply_kinect(
    const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
) {
    for (const auto& bodies : {last_bodies_, exact.bodies})
        for (const PixelRect& rect : bodies)
            look_at(exact, rect.top, rect.bottom);
    last_bodies_ = exact.bodies;
    for (int v = 0; v < height_; ++v)
        kinect_row(random, v, depth_mm.data() + static_cast<std::size_t>(v) * width_);
    kinect_string(exact, random, depth_mm);
    for (std::uint32_t i = 0; i < kSpots; ++i) {
        const std::uint64_t draw = random.draw(spots, i);
        const auto u = static_cast<std::size_t>((draw & 0xFFFFU) % (width_ - 1));
        const auto v = static_cast<std::size_t>((draw >> 16U & 0xFFFFU) % (height_ - 1));
        for (const std::size_t at : {v * width_ + u, (v + 1) * width_ + u})
            depth_mm[at] = depth_mm[at + 1] = 0;
    }
}

/// Takes over rows of exact depth and works out where the projector's light does not come: it
/// stands to the right, so going left its picture u - bf/Z must go left too, else something hides
/// the spot.
void DepthNoise::look_at(const ExactDepth& exact, int top, int bottom) {
    for (int v = top; v < bottom; ++v) {
        const std::size_t begin = static_cast<std::size_t>(v) * width_;
        float* row = lit_.data() + static_cast<std::size_t>(v + kMargin) * stride_ + kMargin;
        const auto baseline = static_cast<float>(shadow_px_m_);
        float leftmost = std::numeric_limits<float>::infinity();
        for (int u = width_ - 1; u >= 0; --u) {
            const float inverse = exact.inverse_depth[begin + u];
            const float projected = static_cast<float>(u) - baseline * inverse;
            row[u] = projected > leftmost ? -inverse : inverse;
            leftmost = std::min(leftmost, projected);
            missing_[begin + u] = kMissingAtGrazing[exact.grazing[begin + u]];
        }
        std::fill(row - kMargin, row, row[0]);
        std::fill(row + width_, row + width_ + kMargin, row[width_ - 1]);
        for (int beyond = 1; beyond <= kMargin; ++beyond) {
            if (v == 0) std::copy_n(row - kMargin, stride_, row - kMargin - beyond * stride_);
            if (v == height_ - 1)
                std::copy_n(row - kMargin, stride_, row - kMargin + beyond * stride_);
        }
    }
}

void DepthNoise::kinect_row(const FrameRandom& random, int v, std::uint16_t* row_mm) {
    const auto start = [&random](Purpose purpose, int row) {
        return place(random.draw(purpose, static_cast<std::uint32_t>(row + kMargin)));
    };
    const float* own = lit_.data() + static_cast<std::size_t>(v + kMargin) * stride_ + kMargin;
    const std::int32_t* aside = aside_.data() + start(sideways, v);
    const std::uint8_t* luck = byte_table().data() + start(loss, v);
    const std::uint8_t* missing = missing_.data() + static_cast<std::size_t>(v) * width_;
    const float* alone = gaussian_table().data() + start(white, v);
    const float* a = smooth_.data() + start(coupled, v - 2);
    const float* b = smooth_.data() + start(coupled, v - 1);
    const float* c = smooth_.data() + start(coupled, v);
    const float* d = smooth_.data() + start(coupled, v + 1);
    const float* e = smooth_.data() + start(coupled, v + 2);
    const auto shared = static_cast<float>(kSigma * std::sqrt(kCoupled) / kPyramidNorm);
    const auto single = static_cast<float>(kSigma * std::sqrt(1.0 - kCoupled));
    float* looked = looked_.data();
    float* noise = noise_.data();
    const int seen = width_ - kBlindColumns;
    for (int u = 0; u < seen; ++u)
        looked[u] = own[u + aside[u]];
    for (int u = 0; u < seen; ++u)
        noise[u] = shared * (a[u] + e[u] + 2.0F * (b[u] + d[u]) + 3.0F * c[u]) + single * alone[u];
    for (int u = 0; u < seen; ++u) {
        const float inverse = looked[u];
        const bool across_edge = std::abs(inverse - std::abs(own[u])) > kEdge;
        const bool lost =
            (inverse <= 0.0F) | (luck[u] < missing[u]) | (across_edge & (luck[u] < kLostAtEdge));
        const float disparity = kStepsAtInfinity - kStepsPerInverse * inverse + noise[u];
        noise[u] = lost ? 0.0F : disparity;
    }
    for (int u = 0; u < seen; ++u)
        row_mm[u] = mm_[to_step(noise[u])];
    std::fill(row_mm + seen, row_mm + width_, std::uint16_t{0});
}

void DepthNoise::kinect_string(
    const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
) const {
    for (const StringPixel& pixel : exact.string) {
        const double luck = random.uniform(string_patch, static_cast<std::uint32_t>(pixel.v / 3));
        if (luck > 0.5 || pixel.u >= width_ - kBlindColumns - 1) continue;
        const auto row = static_cast<std::uint32_t>(pixel.v + kMargin);
        const float gauss = gaussian_table()[place(random.draw(coupled, row)) + pixel.u];
        const int step =
            to_step(kStepsAtInfinity - kStepsPerInverse * pixel.inverse_depth + kSigma * gauss);
        const std::size_t at = static_cast<std::size_t>(pixel.v) * width_ + pixel.u;
        depth_mm[at] = luck < 0.25 ? mm_[step] : std::uint16_t{0};
        if (luck < 0.12) depth_mm[at + 1] = depth_mm[at];  // the correlation window widens it
    }
}

}  // namespace kinectlab::simulate
