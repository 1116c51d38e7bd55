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
constexpr float kPositionMargin = 3e-6F;

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

PixelWindows::Side PixelWindows::side_at(float slope) {
    if (!std::isfinite(slope)) return {slope, 1.0F, 1.0F};
    const float scale = 1.0F / std::sqrt(1.0F + slope * slope);
    return {slope, scale, std::abs(slope) * scale};
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
        std::vector<Side> sides(ranges.size() + 1, side_at(kInfinity));
        float least = kInfinity;
        for (std::size_t i = ranges.size(); i-- > 0;) {
            least = std::min(least, ranges[i].least);
            sides[i] = side_at(least);
        }
        return sides;
    };
    const auto backward = [](const std::vector<Range>& ranges) {
        std::vector<Side> sides(ranges.size() + 1, side_at(-kInfinity));
        float most = -kInfinity;
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            most = std::max(most, ranges[i].most);
            sides[i + 1] = side_at(most);
        }
        return sides;
    };
    const auto per_slope = [](const std::vector<Range>& ranges) {
        const auto seen = [](const Range& range) {
            return range.least <= range.most;
        };
        const auto first = std::find_if(ranges.begin(), ranges.end(), seen);
        const auto last = std::find_if(ranges.rbegin(), ranges.rend(), seen);
        if (first == ranges.end()) return 0.0F;
        const auto apart = static_cast<float>(last.base() - first - 1);
        return apart / std::max(last->least - first->least, 1e-6F);
    };
    columns_per_slope_ = per_slope(columns);
    rows_per_slope_ = per_slope(rows);
    right_of_ = forward(columns);
    below_ = forward(rows);
    left_of_ = backward(columns);
    above_ = backward(rows);
}

void PixelWindows::fit(int u, int v, Point3 from, float radius, std::vector<Strip>& strips) const {
    const float x = sign_x_ * from.x;
    const float y = sign_y_ * from.y;
    const float z = sign_z_ * from.z;
    const float need =
        radius * kRadiusMargin + kPositionMargin * (std::abs(x) + std::abs(y) + std::abs(z));

    // How far what lies from a place on (or before it) is away at least.
    const auto beyond = [z](const std::vector<Side>& sides, int place, float across) {
        const Side& side = sides[static_cast<std::size_t>(place)];
        return (side.slope * z - across) * side.scale;
    };
    const auto before = [z](const std::vector<Side>& sides, int place, float across) {
        const Side& side = sides[static_cast<std::size_t>(place)];
        return (across - side.slope * z) * side.scale;
    };
    // The first column (row) on this side whose points are all far enough away, from a guess on.
    const auto end_of =
        [&](const std::vector<Side>& sides, int middle, int guess, int last, float across) {
            int c = std::min(middle + guess, last);
            while (c < last && !(beyond(sides, c, across) >= need))
                ++c;
            while (c > middle + 1 && beyond(sides, c - 1, across) >= need)
                --c;
            return c;
        };
    const auto begin_of = [&](const std::vector<Side>& sides, int middle, int guess, float across) {
        int c = std::max(middle + 1 - guess, 0);
        while (c > 0 && !(before(sides, c, across) >= need))
            --c;
        while (c < middle && before(sides, c + 1, across) >= need)
            ++c;
        return c;
    };
    const auto guess_of = [](float pixels) {
        return static_cast<int>(std::clamp(pixels, 0.0F, 1e6F)) + 1;
    };
    const float columns = columns_per_slope_ / (z * right_of_[static_cast<std::size_t>(u)].scale);
    const float rows = rows_per_slope_ / (z * below_[static_cast<std::size_t>(v)].scale);
    const int across = guess_of(need * columns);
    const int down = guess_of(need * rows);
    const int last_u = end_of(right_of_, u, across, width_, x) - 1;
    const int last_v = end_of(below_, v, down, height_, y) - 1;
    const int first_u = begin_of(left_of_, u, across, x);
    const int first_v = begin_of(above_, v, down, y);

    const auto sine = [](const std::vector<Side>& sides, int place) {
        return sides[static_cast<std::size_t>(place)].sine;
    };
    const float row_sine = std::max(
        std::max(sine(above_, first_v), sine(above_, v)),
        std::max(sine(below_, v + 1), sine(below_, last_v + 1))
    );
    strips.clear();
    for (int left = first_u; left <= last_u; left += 8) {
        int top = first_v;
        int bottom = last_v;
        const bool to_right = left > u;
        if (to_right || left + 7 < u) {
            const float aside =
                to_right ? beyond(right_of_, left, x) : before(left_of_, left + 8, x);
            const float column_sine = to_right ? sine(right_of_, left) : sine(left_of_, left + 8);
            // Behind two planes with the cosine c between their normals, at a and b, lies nothing
            // nearer than (a² + b²)/(1 + |c|).
            const float rest =
                need * need * (1.0F + column_sine * row_sine) - aside * std::max(aside, 0.0F);
            const float corner = std::sqrt(std::max(rest, 0.0F));
            const int reach = guess_of(corner * rows);
            const int higher = std::max(v + 1 - reach, first_v);
            const int lower = std::min(v + reach, last_v + 1);
            if (before(above_, higher, y) >= corner) top = higher;
            if (beyond(below_, lower, y) >= corner) bottom = lower - 1;
        }
        strips.push_back({static_cast<std::ptrdiff_t>(top) * stride_ + left, bottom - top + 1});
    }
}

}  // namespace kinectlab
