#include "pipeline/features/normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/number_text.hpp"
#include "pipeline/core/vector8.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

constexpr int kMargin = NormalSettings::kMostHalfWindow + 8;  // on all sides, so that no loop clips

/// Inverse depths in a frame of what stands for no reading.
struct Inverse {
    int width, height, stride;
    std::vector<float> values;

    [[nodiscard]] const float* row(int v) const {
        return values.data() + static_cast<std::ptrdiff_t>(v + kMargin) * stride + kMargin;
    }
    [[nodiscard]] float* row(int v) {
        return values.data() + static_cast<std::ptrdiff_t>(v + kMargin) * stride + kMargin;
    }
};

Inverse framed(int width, int height, float value) {
    const int stride = width + 2 * kMargin + 8;
    return {
        width,
        height,
        stride,
        std::vector<float>(
            static_cast<std::size_t>(stride) * static_cast<std::size_t>(height + 2 * kMargin), value
        )};
}

KINECTLAB_HOT_LOOP void invert(const float* z, int n, float* inverse) {
    for (int i = 0; i < n; ++i)
        inverse[i] = z[i] > 0.0F ? 1.0F / z[i] : 0.0F;
}

struct Jump {
    float least, share;
};

/// A row without the pixels that have no reading or leave their surface on the way to the right or
/// downwards: these become NaN, and so does every sum that meets one.
KINECTLAB_HOT_LOOP void leave_out_edges(
    const float* row, const float* below, int n, Jump jump, float* smooth
) {
    const float none = std::numeric_limits<float>::quiet_NaN();
    for (int i = 0; i < n; ++i) {
        const float s = row[i];
        const float share = jump.share * s;
        const float most = share > jump.least ? share : jump.least;
        const float right = std::abs(s - row[i + 1]);
        const float down = std::abs(s - below[i]);
        const float leap = right > down ? right : down;
        const float unbroken = leap > most ? none : s;
        smooth[i] = s > 0.0F ? unbroken : none;
    }
}

/// Sums over the rows of the window, for whole rows of pixels: s and s dv.
struct RowSums {
    std::vector<float> s, s_dv;
    explicit RowSums(std::size_t n) : s(n), s_dv(n) {}
};

KINECTLAB_HOT_LOOP void add_rows(const Inverse& smooth, int v, int half, RowSums& sums) {
    const int from = -kMargin + 8;
    const int n = smooth.width + kMargin - 8;
    for (int i = from; i < n; i += 8) {
        Float8 s = load8(smooth.row(v) + i);
        Float8 s_dv{};
        for (int dv = 1; dv <= half; ++dv) {
            const Float8 below = load8(smooth.row(v + dv) + i);
            const Float8 above = load8(smooth.row(v - dv) + i);
            s += below + above;
            s_dv += (below - above) * static_cast<float>(dv);
        }
        store8(sums.s.data() + kMargin + i, s);
        store8(sums.s_dv.data() + kMargin + i, s_dv);
    }
}

/// Where a row's normals go.
struct RowOut {
    float *x, *y, *z;
};

/// What is the same for all pixels of a row.
struct RowOptics {
    float fx, fy, cx, ray_y;
};

/// s = c + a du + b dv compared with s = (n/d)·ray: the normal is (a fx, b fy, rest), unscaled,
/// away from the camera.
struct Slope {
    Float8 a, b, c;
};

KINECTLAB_INLINE void put_normals(
    const Slope& slope, const Float8& u, const RowOptics& optics, int at, RowOut out
) {
    const float per_fx = 1.0F / optics.fx;
    const Float8 x = slope.a * optics.fx;
    const Float8 y = slope.b * optics.fy;
    const Float8 z = slope.c - x * ((u - optics.cx) * per_fx) - y * optics.ray_y;
    const Float8 squared = x * x + y * y + z * z;
    Float8 root;
    for (int lane = 0; lane < 8; ++lane)
        root[lane] = std::sqrt(squared[lane]);
    const Float8 scale = -1.0F / root;
    store8(out.x + at, x * scale);
    store8(out.y + at, y * scale);
    store8(out.z + at, z * scale);
}

/// The pixels whose windows hold one surface only; the others become NaN. Writes whole eights.
KINECTLAB_HOT_LOOP void fit_smooth(
    const RowSums& sums, int width, int half, const RowOptics& optics, RowOut out
) {
    const Float8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
    const int side = 2 * half + 1;
    const float per_n = 1.0F / static_cast<float>(side * side);
    const float per_second = 3.0F / static_cast<float>(side * half * (half + 1) * side);  // Σ du²
    for (int u = 0; u < width; u += 8) {
        const float* s = sums.s.data() + kMargin + u;
        const float* s_dv = sums.s_dv.data() + kMargin + u;
        Float8 c = load8(s);
        Float8 a{};
        Float8 b = load8(s_dv);
        for (int du = 1; du <= half; ++du) {
            const Float8 right = load8(s + du);
            const Float8 left = load8(s - du);
            c += right + left;
            a += (right - left) * static_cast<float>(du);
            b += load8(s_dv + du) + load8(s_dv - du);
        }
        const Slope slope{a * per_second, b * per_second, c * per_n};
        put_normals(slope, lanes + static_cast<float>(u), optics, u, out);
    }
}

/// Which pixels of a window are looked at where it holds an edge: in a wide one every other,
/// because the sensor correlates windows of pixels, so that neighbours tell little new; and a disc,
/// because its corners show another surface most often.
struct Taps {
    int half, step;
    std::array<int, 2 * NormalSettings::kMostHalfWindow + 1> reach{};  ///< of each row, -1 for none
    int count = 0;

    explicit Taps(int half_window) : half(half_window), step(half_window >= 6 ? 2 : 1) {
        for (int dv = -half; dv <= half; dv += step) {
            int most = half;
            while (most * most + dv * dv > half * (half + 1))
                most -= step;
            reach[static_cast<std::size_t>(dv + half)] = most;
            count += 2 * ((most - first()) / step + 1) - (first() == 0 ? 1 : 0);
        }
    }
    /// Nearest column to the middle: 0, or 1 where every other one leaves the middle out.
    [[nodiscard]] int first() const { return half % step; }
    [[nodiscard]] int reach_of(int dv) const { return reach[static_cast<std::size_t>(dv + half)]; }
};

/// Sums over the neighbours that continue each pixel's own surface, eight pixels side by side.
struct Windows {
    Float8 n{}, u{}, v{}, uu{}, uv{}, vv{}, s{}, su{}, sv{};
};

/// One tap: whether it counts, as 1 or 0, and how far it is from the middle's reading if it does.
struct Tap {
    Float8 one, off;
};

KINECTLAB_INLINE Tap tap(const float* at, const Float8& s0, const Float8& most) {
    const Float8 off = load8(at) - s0;
    const Mask8 in = abs8(off) <= most;
    return {keep8(all8(1.0F), in), keep8(off, in)};
}

/// `most` is below s0, so that no reading, a zero, is always too far off.
KINECTLAB_INLINE Windows sum_windows(
    const Inverse& inverse, int u, int v, const Taps& taps, const Float8& s0, const Float8& most
) {
    Windows sums;
    for (int dv = -taps.half; dv <= taps.half; dv += taps.step) {
        const float* row = inverse.row(v + dv) + u;
        Float8 n{}, mu{}, muu{}, s{}, su{};
        if (taps.first() == 0) {
            const Tap middle = tap(row, s0, most);
            n = middle.one;
            s = middle.off;
        }
        const int reach = taps.reach_of(dv);
        for (int du = taps.first() == 0 ? taps.step : 1; du <= reach; du += taps.step) {
            const Tap right = tap(row + du, s0, most), left = tap(row - du, s0, most);
            const auto x = static_cast<float>(du);
            const Float8 both = right.one + left.one;
            n += both;
            muu += both * (x * x);
            mu += (right.one - left.one) * x;
            s += right.off + left.off;
            su += (right.off - left.off) * x;
        }
        const auto y = static_cast<float>(dv);
        sums.n += n;
        sums.u += mu;
        sums.v += n * y;
        sums.uu += muu;
        sums.uv += mu * y;
        sums.vv += n * (y * y);
        sums.s += s;
        sums.su += su;
        sums.sv += s * y;
    }
    return sums;
}

/// The pixels of a row that have no normal yet, each by its own neighbours: the 3x3 normal
/// equations about the neighbours' centre.
KINECTLAB_HOT_LOOP void fit_rest(
    const Inverse& inverse, int v, const Taps& taps, Jump jump, const RowOptics& optics, RowOut out
) {
    const Float8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
    const float needed = std::max(3.0F, 0.25F * static_cast<float>(taps.count));
    for (int u = 0; u < inverse.width; u += 8) {
        const Float8 s0 = load8(inverse.row(v) + u);
        const Float8 fitted = load8(out.z + u);
        const Mask8 open = (fitted != fitted) & (s0 > 0.0F);
        int any = 0;
        for (int lane = 0; lane < 8; ++lane)
            any |= open[lane];
        if (any == 0) continue;

        const Float8 share = s0 * jump.share;
        const Float8 wide = choose8(share > jump.least, share, all8(jump.least));
        const Float8 below_s0 = 0.999F * s0;
        const Float8 most = choose8(wide < below_s0, wide, below_s0);
        const Windows w = sum_windows(inverse, u, v, taps, s0, most);
        const Float8 inverse_n = 1.0F / w.n;
        const Float8 uu = w.uu - w.u * w.u * inverse_n;
        const Float8 uv = w.uv - w.u * w.v * inverse_n;
        const Float8 vv = w.vv - w.v * w.v * inverse_n;
        const Float8 su = w.su - w.s * w.u * inverse_n;
        const Float8 sv = w.sv - w.s * w.v * inverse_n;
        const Float8 determinant = uu * vv - uv * uv;
        const Mask8 sound = (w.n >= needed) & (determinant > uu * vv * 1e-3F);
        const Float8 a = (su * vv - sv * uv) / determinant;
        const Float8 b = (sv * uu - su * uv) / determinant;
        const Float8 c = s0 + (w.s - a * w.u - b * w.v) * inverse_n;

        const Float8 x = a * optics.fx;
        const Float8 y = b * optics.fy;
        const Float8 at = lanes + static_cast<float>(u);
        const Float8 z = c - a * (at - optics.cx) - y * optics.ray_y;
        const Float8 squared = x * x + y * y + z * z;
        Float8 root;
        for (int lane = 0; lane < 8; ++lane)
            root[lane] = std::sqrt(squared[lane]);
        const Mask8 now = open & sound;
        store8(out.x + u, choose8(now, -x / root, load8(out.x + u)));
        store8(out.y + u, choose8(now, -y / root, load8(out.y + u)));
        store8(out.z + u, choose8(now, -z / root, load8(out.z + u)));
    }
}

class NormalFinder {
public:
    NormalFinder(const Cloud& cloud, const Pinhole& camera, const NormalSettings& settings)
        : camera_(camera),
          half_(settings.half_window),
          jump_{
              static_cast<float>(settings.max_jump_per_m),
              static_cast<float>(settings.max_jump_share)},
          inverse_(framed(cloud.width, cloud.height, 0.0F)),
          smooth_(framed(cloud.width, cloud.height, std::numeric_limits<float>::quiet_NaN())) {
        for (int v = 0; v < cloud.height; ++v)
            invert(
                cloud.z.data() + static_cast<std::ptrdiff_t>(v) * cloud.width,
                cloud.width,
                inverse_.row(v)
            );
        for (int v = 0; v < cloud.height; ++v)
            leave_out_edges(
                inverse_.row(v), inverse_.row(v + 1), cloud.width, jump_, smooth_.row(v)
            );
    }

    NormalImage find() {
        NormalImage image{inverse_.width, inverse_.height, {}, {}, {}};
        const auto width = static_cast<std::size_t>(image.width);
        for (auto* axis : {&image.x, &image.y, &image.z})
            axis->resize(width * static_cast<std::size_t>(image.height));
        const Taps taps(half_);
        RowSums sums(static_cast<std::size_t>(inverse_.stride) + 16);
        std::vector<float> row(3 * (width + 8));
        const RowOut out{row.data(), row.data() + width + 8, row.data() + 2 * (width + 8)};
        for (int v = 0; v < image.height; ++v) {
            const RowOptics optics{
                static_cast<float>(camera_.fx),
                static_cast<float>(camera_.fy),
                static_cast<float>(camera_.cx),
                static_cast<float>((v - camera_.cy) / camera_.fy)};
            add_rows(smooth_, v, half_, sums);
            fit_smooth(sums, image.width, half_, optics, out);
            fit_rest(inverse_, v, taps, jump_, optics, out);
            const auto to = static_cast<std::ptrdiff_t>(v) * image.width;
            std::copy_n(out.x, width, image.x.begin() + to);
            std::copy_n(out.y, width, image.y.begin() + to);
            std::copy_n(out.z, width, image.z.begin() + to);
        }
        return image;
    }

private:
    Pinhole camera_;
    int half_;
    Jump jump_;
    Inverse inverse_, smooth_;
};

Result<void> check(const Cloud& cloud, const Pinhole& camera, const NormalSettings& settings) {
    if (auto right = check_shape(cloud); !right) return right;
    if (cloud.width != camera.width || cloud.height != camera.height)
        return fail(
            ErrorCode::bad_data,
            "cloud",
            "is " + std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                " points, but the camera has " + std::to_string(camera.width) + " x " +
                std::to_string(camera.height) + " pixels",
            "give the camera that the cloud was made with"
        );
    const auto wrong = [](const char* field, double value, const std::string& cure) {
        return fail(ErrorCode::invalid_argument, field, "is " + number_text(value), cure);
    };
    if (settings.half_window < 1 || settings.half_window > NormalSettings::kMostHalfWindow)
        return wrong(
            "half_window",
            settings.half_window,
            "give pixels from 1 to " + std::to_string(NormalSettings::kMostHalfWindow)
        );
    if (!std::isfinite(settings.max_jump_per_m) || settings.max_jump_per_m <= 0.0)
        return wrong("max_jump_per_m", settings.max_jump_per_m, "give 1/m above 0, such as 0.0228");
    if (!std::isfinite(settings.max_jump_share) || settings.max_jump_share < 0.0)
        return wrong("max_jump_share", settings.max_jump_share, "give 0 or more, such as 0.015");
    return {};
}

}  // namespace

Result<NormalImage> find_normals(
    const Cloud& cloud, const Pinhole& camera, const NormalSettings& settings
) {
    if (auto right = check(cloud, camera, settings); !right) return tl::unexpected(right.error());
    return NormalFinder(cloud, camera, settings).find();
}

}  // namespace kinectlab
