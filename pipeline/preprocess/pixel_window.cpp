#include "pipeline/preprocess/pixel_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinectlab {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kPadding = 8;
// More than float rounding can take from the bounds and the distances.
constexpr float kRadiusMargin = 1.0001F;
constexpr float kPositionMargin = 2e-6F;

struct Range {
    float least = kInfinity;
    float most = -kInfinity;
    void add(float value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

/// -1 if values fall from the first to the last range, otherwise 1.
float direction_of(const std::vector<Range>& ranges) {
    const auto seen = [](const Range& range) {
        return range.least <= range.most;
    };
    const auto first = std::find_if(ranges.begin(), ranges.end(), seen);
    const auto last = std::find_if(ranges.rbegin(), ranges.rend(), seen);
    if (first == ranges.end()) return 1.0F;
    return last->least + last->most < first->least + first->most ? -1.0F : 1.0F;
}

void turn(std::vector<Range>& ranges, float sign) {
    if (sign > 0.0F) return;
    for (auto& range : ranges)
        range = {-range.most, -range.least};
}

float scale_of(float slope) {
    return std::isfinite(slope) ? 1.0F / std::sqrt(1.0F + slope * slope) : 1.0F;
}

}  // namespace

std::optional<PixelWindows> PixelWindows::of(const Cloud& cloud) {
    if (!cloud.organised()) return std::nullopt;
    bool in_front = false;
    bool behind = false;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (!cloud.valid(i)) continue;
        in_front = in_front || !(cloud.z[i] < 0.0F);
        behind = behind || !(cloud.z[i] > 0.0F);
    }
    if (in_front && behind) return std::nullopt;

    PixelWindows windows;
    windows.width_ = cloud.width;
    windows.height_ = cloud.height;
    windows.stride_ = cloud.width + kPadding;
    windows.sign_z_ = behind ? -1.0F : 1.0F;
    const auto points =
        static_cast<std::size_t>(windows.stride_) * static_cast<std::size_t>(cloud.height);
    for (auto* axis : {&windows.x_, &windows.y_, &windows.z_})
        axis->assign(points, std::numeric_limits<float>::quiet_NaN());
    for (int v = 0; v < cloud.height; ++v) {
        const auto from = static_cast<std::ptrdiff_t>(v) * cloud.width;
        const auto to = static_cast<std::ptrdiff_t>(v) * windows.stride_;
        std::copy_n(cloud.x.begin() + from, cloud.width, windows.x_.begin() + to);
        std::copy_n(cloud.y.begin() + from, cloud.width, windows.y_.begin() + to);
        std::copy_n(cloud.z.begin() + from, cloud.width, windows.z_.begin() + to);
    }
    windows.find_sides(cloud);
    return windows;
}

void PixelWindows::find_sides(const Cloud& cloud) {
    std::vector<Range> columns(static_cast<std::size_t>(width_));
    std::vector<Range> rows(static_cast<std::size_t>(height_));
    for (int v = 0; v < height_; ++v) {
        for (int u = 0; u < width_; ++u) {
            const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(u);
            if (!cloud.valid(i)) continue;
            columns[static_cast<std::size_t>(u)].add(cloud.x[i] / cloud.z[i]);
            rows[static_cast<std::size_t>(v)].add(cloud.y[i] / cloud.z[i]);
        }
    }
    const float right = direction_of(columns);
    const float down = direction_of(rows);
    turn(columns, right);
    turn(rows, down);
    sign_x_ = right * sign_z_;
    sign_y_ = down * sign_z_;

    const auto forward = [](const std::vector<Range>& ranges) {
        std::vector<Side> sides(ranges.size() + 1, Side{kInfinity, 1.0F});
        float least = kInfinity;
        for (std::size_t i = ranges.size(); i-- > 0;) {
            least = std::min(least, ranges[i].least);
            sides[i] = {least, scale_of(least)};
        }
        return sides;
    };
    const auto backward = [](const std::vector<Range>& ranges) {
        std::vector<Side> sides(ranges.size() + 1, Side{-kInfinity, 1.0F});
        float most = -kInfinity;
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            most = std::max(most, ranges[i].most);
            sides[i + 1] = {most, scale_of(most)};
        }
        return sides;
    };
    right_of_ = forward(columns);
    below_ = forward(rows);
    left_of_ = backward(columns);
    above_ = backward(rows);
}

bool PixelWindows::fit(int u, int v, Point3 from, float radius, PixelWindow& window) const {
    const float x = sign_x_ * from.x;
    const float y = sign_y_ * from.y;
    const float z = sign_z_ * from.z;
    const float need =
        radius * kRadiusMargin + kPositionMargin * (std::abs(x) + std::abs(y) + std::abs(z));

    // The first column (row) on this side whose points are all far enough away.
    const auto far_from =
        [&](const std::vector<Side>& sides, int start, int middle, int last, float across) {
            const auto far = [&](int c) {
                const Side& side = sides[static_cast<std::size_t>(c)];
                return (side.slope * z - across) * side.scale >= need;
            };
            int c = std::clamp(start, middle + 1, last);
            while (c < last && !far(c))
                ++c;
            while (c > middle + 1 && far(c - 1))
                --c;
            return c;
        };
    const auto far_before = [&](const std::vector<Side>& sides, int start, int middle, float across
                            ) {
        const auto far = [&](int c) {
            const Side& side = sides[static_cast<std::size_t>(c)];
            return (across - side.slope * z) * side.scale >= need;
        };
        int c = std::clamp(start, 0, middle);
        while (c > 0 && !far(c))
            --c;
        while (c < middle && far(c + 1))
            ++c;
        return c;
    };
    window.right = far_from(right_of_, window.right + 1, u, width_, x) - 1;
    window.bottom = far_from(below_, window.bottom + 1, v, height_, y) - 1;
    window.left = far_before(left_of_, window.left, u, x);
    window.top = far_before(above_, window.top, v, y);
    return window.right - window.left < kMostSide && window.bottom - window.top < kMostSide;
}

PointRows PixelWindows::rows(const PixelWindow& window) const {
    const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(window.top) * stride_ + window.left;
    return {
        x_.data() + start,
        y_.data() + start,
        z_.data() + start,
        stride_,
        window.bottom - window.top + 1,
        window.right - window.left + 1};
}

}  // namespace kinectlab
