#include <algorithm>
#include <cmath>
#include <cstring>

#include <Eigen/LU>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/features/sift.hpp"

namespace kinectlab {
namespace {

constexpr float kCameraBlur = 0.5F;  // σ in px that a sharp picture has already (Lowe 2004, 3.3)
constexpr int kSmallest = 12;        // px, side of the last octave
constexpr int kBorder = 4;           // px without keypoints
constexpr int kMostMoves = 5;        // of a refinement before it is given up

KINECTLAB_HOT_LOOP void subtract(
    const float* __restrict upper, const float* __restrict lower, int count, float* __restrict out
) {
    for (int i = 0; i < count; ++i)
        out[i] = upper[i] - lower[i];
}

/// 1 where a pixel is beyond `least` and beats its 8 neighbours in its own layer. Most of a picture
/// is too flat, which is asked for a block at once.
KINECTLAB_HOT_LOOP void mark_peaks(
    const float* __restrict above,
    const float* __restrict own,
    const float* __restrict below,
    int from,
    int to,
    float least,
    std::uint8_t* __restrict peaks
) {
    constexpr int kBlock = 64;
    for (int start = from; start < to; start += kBlock) {
        const int end = std::min(to, start + kBlock);
        int beyond = 0;
        for (int i = start; i < end; ++i)
            beyond |= static_cast<int>(own[i] > least) | static_cast<int>(own[i] < -least);
        if (beyond == 0) {
            std::fill(peaks + start, peaks + end, std::uint8_t{0});
            continue;
        }
        for (int i = start; i < end; ++i) {
            const float high = std::max(
                std::max(std::max(above[i - 1], above[i]), std::max(above[i + 1], own[i - 1])),
                std::max(std::max(own[i + 1], below[i - 1]), std::max(below[i], below[i + 1]))
            );
            const float low = std::min(
                std::min(std::min(above[i - 1], above[i]), std::min(above[i + 1], own[i - 1])),
                std::min(std::min(own[i + 1], below[i - 1]), std::min(below[i], below[i + 1]))
            );
            const float here = own[i];
            const int peak = static_cast<int>(here > least) & static_cast<int>(here > high);
            const int pit = static_cast<int>(here < -least) & static_cast<int>(here < low);
            peaks[i] = static_cast<std::uint8_t>(peak | pit);
        }
    }
}

/// The next that is marked; `end` if none is.
const std::uint8_t* next_peak(const std::uint8_t* from, const std::uint8_t* end) {
    const void* found = std::memchr(from, 1, static_cast<std::size_t>(end - from));
    return found != nullptr ? static_cast<const std::uint8_t*>(found) : end;
}

/// Differences of Gaussians around a pixel, straight from the blurred layers.
class Neighbourhood {
public:
    Neighbourhood(const GreyImage* layers, int layer, int x, int y)
        : layers_(layers), layer_(layer), x_(x), y_(y) {}
    float operator()(int dx, int dy, int ds) const {
        const GreyImage* at = layers_ + layer_ + ds;
        return at[1].row(y_ + dy)[x_ + dx] - at[0].row(y_ + dy)[x_ + dx];
    }

private:
    const GreyImage* layers_;
    int layer_, x_, y_;
};

bool beats_other_scales(const Neighbourhood& d) {
    const float here = d(0, 0, 0);
    for (const int ds : {-1, 1})
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const float other = d(dx, dy, ds);
                if (here > 0.0F ? other >= here : other <= here) return false;
            }
    return true;
}

}  // namespace

void Sift::find(std::span<const std::uint8_t> rgb, int width, const ImageRegion& region) {
    keypoints_.clear();
    descriptors_.clear();
    region_ = region;
    if (region.right - region.left < 16 || region.bottom - region.top < 16) return;
    grey_of(rgb, width, region, grey_);
    build();
    for (int octave = 0; octave < octaves_; ++octave)
        find_extrema(octave);
    // Oriented keypoints follow the refined ones in the same list, which is then cut.
    const std::size_t refined = keypoints_.size();
    for (std::size_t i = 0; i < refined; ++i)
        orient(Keypoint2d(keypoints_[i]));
    keypoints_.erase(keypoints_.begin(), keypoints_.begin() + static_cast<std::ptrdiff_t>(refined));
    descriptors_.resize(keypoints_.size());
    for (std::size_t i = 0; i < keypoints_.size(); ++i)
        describe(keypoints_[i], descriptors_[i]);
}

void Sift::build() {
    const int per_octave = settings_.scales_per_octave + 3;
    const float present = settings_.doubled ? 2.0F * kCameraBlur : kCameraBlur;
    if (settings_.doubled)
        kinectlab::doubled(grey_, base_);
    else
        base_ = grey_;
    octaves_ = 0;
    for (int side = std::min(base_.width, base_.height); side >= kSmallest; side /= 2)
        ++octaves_;
    layers_.resize(std::max(layers_.size(), static_cast<std::size_t>(octaves_ * per_octave)));

    blur(
        base_,
        std::sqrt(settings_.sigma * settings_.sigma - present * present),
        layer(0, 0),
        scratch_
    );
    const int above = settings_.scales_per_octave + 1;  // these layers the next octave has as well
    const float ratio = std::exp2(1.0F / static_cast<float>(settings_.scales_per_octave));
    for (int octave = 0; octave < octaves_; ++octave) {
        if (octave > 0) halved(layer(octave - 1, settings_.scales_per_octave), layer(octave, 0));
        const int end = octave + 1 < octaves_ ? above : per_octave;
        float sigma = settings_.sigma;
        for (int i = 1; i < end; ++i, sigma *= ratio)
            blur(
                layer(octave, i - 1),
                sigma * std::sqrt(ratio * ratio - 1.0F),
                layer(octave, i),
                scratch_
            );
    }
    // The widest blurs, half of all the work, are done at half the size and brought back.
    for (int octave = octaves_ - 2; octave >= 0; --octave)
        for (int i = above; i < per_octave; ++i) {
            const GreyImage& full = layer(octave, 0);
            unhalved(
                layer(octave + 1, i - settings_.scales_per_octave),
                full.width,
                full.height,
                layer(octave, i),
                scratch_
            );
        }
}

void Sift::find_extrema(int octave) {
    const int width = layer(octave, 0).width, height = layer(octave, 0).height;
    if (width <= 2 * kBorder || height <= 2 * kBorder) return;
    const auto row_size = static_cast<std::size_t>(width);
    rows_.resize(3 * row_size);
    peaks_.resize(row_size);
    const float least = 0.5F * settings_.least_contrast;
    for (int i = 1; i <= settings_.scales_per_octave; ++i) {
        const GreyImage& lower = layer(octave, i);
        const GreyImage& upper = layer(octave, i + 1);
        const auto row_of = [&](int v) {
            return rows_.data() + static_cast<std::size_t>(v % 3) * row_size;
        };
        const auto fill = [&](int v) {
            subtract(upper.row(v), lower.row(v), width, row_of(v));
        };
        fill(kBorder - 1);
        fill(kBorder);
        for (int v = kBorder; v < height - kBorder; ++v) {
            fill(v + 1);
            mark_peaks(
                row_of(v - 1),
                row_of(v),
                row_of(v + 1),
                kBorder,
                width - kBorder,
                least,
                peaks_.data()
            );
            const std::uint8_t* end = peaks_.data() + (width - kBorder);
            for (const std::uint8_t* at = next_peak(peaks_.data() + kBorder, end); at != end;
                 at = next_peak(at + 1, end)) {
                const auto u = static_cast<int>(at - peaks_.data());
                if (beats_other_scales({&layer(octave, 0), i, u, v})) refine(octave, i, u, v);
            }
        }
    }
}

/// Moves to where the quadratic through the neighbours has its extremum (Lowe 2004, section 4).
void Sift::refine(int octave, int index, int x, int y) {
    const int width = layer(octave, 0).width, height = layer(octave, 0).height;
    for (int move = 0; move < kMostMoves; ++move) {
        const Neighbourhood d(&layer(octave, 0), index, x, y);
        const float here = d(0, 0, 0);
        const Eigen::Vector3f slope(
            0.5F * (d(1, 0, 0) - d(-1, 0, 0)),
            0.5F * (d(0, 1, 0) - d(0, -1, 0)),
            0.5F * (d(0, 0, 1) - d(0, 0, -1))
        );
        const float xx = d(1, 0, 0) + d(-1, 0, 0) - 2.0F * here;
        const float yy = d(0, 1, 0) + d(0, -1, 0) - 2.0F * here;
        const float ss = d(0, 0, 1) + d(0, 0, -1) - 2.0F * here;
        const float xy = 0.25F * (d(1, 1, 0) - d(-1, 1, 0) - d(1, -1, 0) + d(-1, -1, 0));
        const float xs = 0.25F * (d(1, 0, 1) - d(-1, 0, 1) - d(1, 0, -1) + d(-1, 0, -1));
        const float ys = 0.25F * (d(0, 1, 1) - d(0, -1, 1) - d(0, 1, -1) + d(0, -1, -1));
        Eigen::Matrix3f curvature;
        curvature << xx, xy, xs, xy, yy, ys, xs, ys, ss;
        const Eigen::Vector3f off = -(curvature.inverse() * slope);
        if (!off.allFinite() || off.cwiseAbs().maxCoeff() > 8.0F) return;
        if (off.cwiseAbs().maxCoeff() < 0.5F) {
            const float contrast = std::abs(here + 0.5F * slope.dot(off));
            const float determinant = xx * yy - xy * xy, trace = xx + yy;
            const float edge = settings_.most_edge;
            if (contrast < settings_.least_contrast || determinant <= 0.0F ||
                trace * trace * edge >= (edge + 1.0F) * (edge + 1.0F) * determinant)
                return;
            const float pixel = std::exp2(static_cast<float>(octave - (settings_.doubled ? 1 : 0)));
            Keypoint2d found;
            found.x = static_cast<float>(x) + off.x();
            found.y = static_cast<float>(y) + off.y();
            found.u = found.x * pixel + static_cast<float>(region_.left);
            found.v = found.y * pixel + static_cast<float>(region_.top);
            found.octave = static_cast<std::uint8_t>(octave);
            found.layer = static_cast<std::uint8_t>(index);
            found.scale_px = pixel * settings_.sigma *
                             std::exp2(
                                 (static_cast<float>(index) + off.z()) /
                                 static_cast<float>(settings_.scales_per_octave)
                             );
            found.response = contrast;
            keypoints_.push_back(found);
            return;
        }
        x += static_cast<int>(std::lround(off.x()));
        y += static_cast<int>(std::lround(off.y()));
        index += static_cast<int>(std::lround(off.z()));
        if (index < 1 || index > settings_.scales_per_octave || x < kBorder || y < kBorder ||
            x >= width - kBorder || y >= height - kBorder)
            return;
    }
}

}  // namespace kinectlab
