#include "pipeline/track/first_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "pipeline/features/two_cameras.hpp"

namespace kinectlab {
namespace {

constexpr std::size_t kFewestPixels = 60;  // fewer are noise
constexpr std::size_t kShareOfBox = 5;     // what moved fills at least a fifth of the box
constexpr int kAroundClick_px = 4;         // a reading is looked for so far from a click
constexpr int kSeed_px = 2;                // the click's colour is the median so far around it
constexpr int kSmallClick_px = 8;          // a box up to this size is meant as a click
constexpr double kLargest = 0.25;          // of the picture: not a thing but the room
constexpr int kEdge_px = 3;                // around a thing, where colours are mixed
constexpr int kNarrowest_px = 8;           // of the surroundings
constexpr float kChroma = 0.14F, kBrightness = 0.35F;  // how far a grown colour may lie off
constexpr float kNoise = 0.02F;  // of the picture's values: in the dark it alone makes a chroma

Error wrong(const std::string& field, std::string what, std::string cure) {
    return {ErrorCode::invalid_argument, field, std::move(what), std::move(cure)};
}

/// Red to green and blue to yellow, each -1 to 1: no hue where there is no saturation.
Eigen::Vector2f chroma(const Hsv& hsv) {
    const float angle = hsv.hue_deg * 0.01745329F;
    return hsv.saturation * Eigen::Vector2f(std::cos(angle), std::sin(angle));
}

bool alike(const Hsv& a, const Hsv& b) {
    const float brighter = std::max(a.value, b.value), darker = std::min(a.value, b.value);
    const float chroma_noise = kNoise / std::max(darker, kNoise);
    return (chroma(a) - chroma(b)).norm() <= kChroma + chroma_noise &&
           brighter - darker <= kBrightness * brighter + 0.03F;
}

}  // namespace

FirstLook::FirstLook(const RgbdCamera& camera)
    : camera_(camera),
      pieces_(camera),
      mask_(static_cast<std::size_t>(camera.depth.width * camera.depth.height)) {}

Hsv FirstLook::colour(std::uint32_t pixel) const {
    const auto* p = frame_->rgb.data() + 3 * static_cast<std::ptrdiff_t>(colour_index_[pixel]);
    const auto part = [&](std::size_t c) {
        return std::min(1.0F, gains_[c] * static_cast<float>(p[c]) / 255.0F);
    };
    return hsv_of(part(0), part(1), part(2));
}

Result<void> FirstLook::take(
    const RgbdFrame& frame,
    std::span<const std::int32_t> colour_index,
    const ColourConstancy::Gains& gains,
    std::span<const MovedPixels> moved,
    const PictureBox& place,
    const std::string& field
) {
    frame_ = &frame;
    colour_index_ = colour_index;
    gains_ = gains;
    pixels_.clear();
    inside_.clear();
    outside_.clear();

    // What the place shows, and the reading nearest to its middle.
    const bool click = place.width <= kSmallClick_px && place.height <= kSmallClick_px;
    const int margin = click ? kAroundClick_px : 0;
    std::optional<std::uint32_t> middle;
    double nearest = 1e9;
    for (std::size_t i = 0; i < mask_.size(); ++i) {
        mask_[i] = 0;
        if (colour_index[i] < 0) continue;
        const int u = colour_index[i] % camera_.colour.width - place.left;
        const int v = colour_index[i] / camera_.colour.width - place.top;
        if (u < -margin || v < -margin || u >= place.width + margin || v >= place.height + margin)
            continue;
        mask_[i] = 1;
        const double off = std::hypot(u - 0.5 * (place.width - 1), v - 0.5 * (place.height - 1));
        if (off >= nearest) continue;
        nearest = off;
        middle = static_cast<std::uint32_t>(i);
    }
    if (!middle)
        return tl::unexpected(wrong(
            field,
            "lies where the camera reads no depth",
            "choose a place that the depth picture shows: no shadow, nothing black or shiny, not "
            "outside of its view"
        ));
    if (click)
        take_click(frame, moved, *middle);
    else
        take_box(moved);
    if (pixels_.size() < kFewestPixels)
        return tl::unexpected(wrong(
            field,
            "shows only " + std::to_string(pixels_.size()) + " depth pixels of one colour",
            "at least " + std::to_string(kFewestPixels) +
                " are needed: choose a larger patch, come nearer, or draw a box around the thing"
        ));
    if (static_cast<double>(pixels_.size()) > kLargest * static_cast<double>(mask_.size()))
        return tl::unexpected(wrong(
            field,
            "shows a surface that fills " + std::to_string(100 * pixels_.size() / mask_.size()) +
                " % of the picture",
            "click on a thing, not on a wall, or draw a box around it"
        ));
    for (const auto pixel : pixels_)
        if (colour_index[pixel] >= 0) inside_.push_back(colour(pixel));
    look_around(place);
    return {};
}

void FirstLook::take_box(std::span<const MovedPixels> moved) {
    const auto in_box = static_cast<std::size_t>(std::count(mask_.begin(), mask_.end(), 1));
    const auto inside = [&](std::uint32_t pixel) {
        return mask_[pixel] != 0;
    };
    MovedPixels most;
    std::size_t most_inside = 0;
    for (const auto& segment : moved) {
        const auto count =
            static_cast<std::size_t>(std::count_if(segment.begin(), segment.end(), inside));
        if (count <= most_inside) continue;
        most_inside = count;
        most = segment;
    }
    if (most_inside >= kFewestPixels && most_inside * kShareOfBox >= in_box) {
        std::copy_if(most.begin(), most.end(), std::back_inserter(pixels_), inside);
        return;
    }
    for (std::uint32_t i = 0; i < mask_.size(); ++i)
        if (mask_[i] != 0) pixels_.push_back(i);
}

void FirstLook::take_click(
    const RgbdFrame& frame, std::span<const MovedPixels> moved, std::uint32_t at
) {
    for (const auto& segment : moved)
        if (std::find(segment.begin(), segment.end(), at) != segment.end()) {
            pixels_.assign(segment.begin(), segment.end());
            return;
        }
    grow(frame, at);
}

void FirstLook::grow(const RgbdFrame& frame, std::uint32_t at) {
    // The middle of the click's colours, so that one noisy pixel decides nothing.
    const int width = camera_.depth.width;
    std::vector<float> x, y, value;
    for (int dv = -kSeed_px; dv <= kSeed_px; ++dv)
        for (int du = -kSeed_px; du <= kSeed_px; ++du) {
            const std::int64_t i = std::int64_t{at} + dv * width + du;
            if (i < 0 || i >= static_cast<std::int64_t>(mask_.size())) continue;
            const auto pixel = static_cast<std::uint32_t>(i);
            if (colour_index_[pixel] < 0) continue;
            const Hsv hsv = colour(pixel);
            x.push_back(chroma(hsv).x());
            y.push_back(chroma(hsv).y());
            value.push_back(hsv.value);
        }
    const auto median = [](std::vector<float>& values) {
        std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
        return values[values.size() / 2];
    };
    const Eigen::Vector2f hue(median(x), median(y));
    float angle = std::atan2(hue.y(), hue.x()) / 0.01745329F;
    if (angle < 0.0F) angle += 360.0F;
    const Hsv seed{angle, hue.norm(), median(value)};

    for (std::uint32_t i = 0; i < mask_.size(); ++i)
        mask_[i] = colour_index_[i] >= 0 && alike(colour(i), seed) ? 1 : 0;
    mask_[at] = 1;
    for (const auto& piece : pieces_.cut(frame.depth, mask_, 1)) {
        if (std::find(piece.begin(), piece.end(), at) == piece.end()) continue;
        pixels_.assign(piece.begin(), piece.end());
        return;
    }
}

void FirstLook::look_around(const PictureBox& place) {
    const int width = camera_.depth.width, height = camera_.depth.height;
    int left = width, top = height, right = 0, bottom = 0;
    std::fill(mask_.begin(), mask_.end(), std::uint8_t{0});
    for (const auto pixel : pixels_) {
        const int u = static_cast<int>(pixel) % width, v = static_cast<int>(pixel) / width;
        left = std::min(left, u), right = std::max(right, u + 1);
        top = std::min(top, v), bottom = std::max(bottom, v + 1);
        for (int dv = -kEdge_px; dv <= kEdge_px; ++dv)
            for (int du = -kEdge_px; du <= kEdge_px; ++du)
                if (u + du >= 0 && u + du < width && v + dv >= 0 && v + dv < height)
                    mask_[static_cast<std::size_t>((v + dv) * width + u + du)] = 1;
    }
    const int wide = std::max(kNarrowest_px, (right - left) / 2);
    const int high = std::max(kNarrowest_px, (bottom - top) / 2);
    for (int v = std::max(0, top - high); v < std::min(height, bottom + high); ++v)
        for (int u = std::max(0, left - wide); u < std::min(width, right + wide); ++u) {
            const auto pixel = static_cast<std::uint32_t>(v * width + u);
            if (mask_[pixel] != 0 || colour_index_[pixel] < 0) continue;
            // A box says that what lies within it may be the thing.
            const int du = colour_index_[pixel] % camera_.colour.width - place.left;
            const int dv = colour_index_[pixel] / camera_.colour.width - place.top;
            if (du >= 0 && dv >= 0 && du < place.width && dv < place.height) continue;
            outside_.push_back(colour(pixel));
        }
}

}  // namespace kinectlab
