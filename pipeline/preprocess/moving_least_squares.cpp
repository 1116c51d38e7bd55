#include "pipeline/preprocess/moving_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/number_text.hpp"
#include "pipeline/core/vector8.hpp"
#include "pipeline/preprocess/moving_least_squares_settings.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

constexpr int kLanes = 8;
constexpr float kNoiseSigmas = 3.0F;
constexpr float kLeastPivot = 1e-4F;  // of what it was before elimination: below is singular

/// The cloud's depths with a margin all around, so that no window has to be cut.
struct PaddedDepth {
    int margin, stride;
    std::vector<float> z;

    [[nodiscard]] const float* row(int v) const {
        return z.data() + static_cast<std::ptrdiff_t>(v + margin) * stride + margin;
    }
};

PaddedDepth pad(const Cloud& cloud, int margin) {
    PaddedDepth padded{margin, cloud.width + 2 * margin + kLanes, {}};
    padded.z.assign(
        static_cast<std::size_t>(padded.stride) *
            static_cast<std::size_t>(cloud.height + 2 * margin),
        std::numeric_limits<float>::quiet_NaN()
    );
    for (int v = 0; v < cloud.height; ++v)
        std::copy_n(
            cloud.z.begin() + static_cast<std::ptrdiff_t>(v) * cloud.width,
            cloud.width,
            padded.z.begin() + (padded.row(v) - padded.z.data())
        );
    return padded;
}

/// Σθ u^k v^j and Σθ f u^k v^j of eight pixels; u and v in windows' half-sizes.
struct Moments {
    Float8 count;
    Float8 of[5][5];  ///< [j][k], j + k <= 4
    Float8 f[3][3];   ///< j + k <= 2
};

/// Adds one row of the window, dv away. `u_step` is one pixel in half-sizes.
KINECTLAB_INLINE void add_row(
    Moments& moments,
    const float* row,
    int reach,
    float u_step,
    float v_far,
    const Float8& z0,
    const Float8& gate,
    const Float8* weights
) {
    Float8 s0{}, s1{}, s2{}, s3{}, s4{}, t0{}, t1{}, t2{};
    Mask8 number{};
    {
        const Float8 f = load8(row) - z0;
        const Mask8 near = abs8(f) <= gate;
        const Float8 w = keep8(weights[0], near);
        number -= w > 0.0F;
        s0 += w;
        t0 += keep8(w * f, near);
    }
    for (int du = 1; du <= reach; ++du) {
        const float u = static_cast<float>(du) * u_step;
        const Float8 f_right = load8(row + du) - z0;
        const Float8 f_left = load8(row - du) - z0;
        const Mask8 right = abs8(f_right) <= gate;
        const Mask8 left = abs8(f_left) <= gate;
        const Float8 w_right = keep8(weights[du], right);
        const Float8 w_left = keep8(weights[du], left);
        number -= (w_right > 0.0F) + (w_left > 0.0F);
        const Float8 wf_right = keep8(w_right * f_right, right);
        const Float8 wf_left = keep8(w_left * f_left, left);
        const Float8 even = w_right + w_left;
        const Float8 odd = (w_right - w_left) * u;
        const Float8 even2 = even * (u * u);
        s0 += even;
        s1 += odd;
        s2 += even2;
        s3 += odd * (u * u);
        s4 += even2 * (u * u);
        const Float8 f_even = wf_right + wf_left;
        t0 += f_even;
        t1 += (wf_right - wf_left) * u;
        t2 += f_even * (u * u);
    }
    moments.count += __builtin_convertvector(number, Float8);
    const Float8 s[5] = {s0, s1, s2, s3, s4};
    const Float8 t[3] = {t0, t1, t2};
    float power = 1.0F;
    for (int j = 0; j <= 4; ++j) {
        for (int k = 0; j + k <= 4; ++k)
            moments.of[j][k] += s[k] * power;
        for (int k = 0; j + k <= 2; ++k)
            moments.f[j][k] += t[k] * power;
        power *= v_far;
    }
}

struct Fit {
    Float8 value;  ///< c for the basis function 1, which is f at the pixel itself
    Mask8 sound;
};

/// Equation 4 by Gaussian elimination without pivoting (the matrix is positive definite), the
/// constant last, so that nothing has to be substituted back.
template <int kSize>
KINECTLAB_INLINE Fit eliminate(Float8 (&a)[kSize][kSize], Float8 (&b)[kSize], const Mask8& enough) {
    Mask8 sound = enough;
    for (int p = 0; p < kSize - 1; ++p) {
        const Float8 inverse = 1.0F / a[p][p];
        for (int i = p + 1; i < kSize; ++i) {
            const Float8 factor = a[p][i] * inverse;
            const Float8 before = a[i][i];
            for (int k = i; k < kSize; ++k)
                a[i][k] -= factor * a[p][k];
            b[i] -= factor * b[p];
            sound &= a[i][i] > before * kLeastPivot;
        }
    }
    const Float8 value = b[kSize - 1] / a[kSize - 1][kSize - 1];
    return {value, sound & (abs8(value) < 1e6F)};
}

KINECTLAB_INLINE Fit fit_quadratic(const Moments& m) {
    // u², v², uv, u, v, 1 as exponents of u and v.
    constexpr int ku[6] = {2, 0, 1, 1, 0, 0};
    constexpr int kv[6] = {0, 2, 1, 0, 1, 0};
    Float8 a[6][6], b[6];
    for (int i = 0; i < 6; ++i) {
        for (int k = i; k < 6; ++k)
            a[i][k] = m.of[kv[i] + kv[k]][ku[i] + ku[k]];
        b[i] = m.f[kv[i]][ku[i]];
    }
    return eliminate<6>(a, b, m.count >= 12.0F);
}

KINECTLAB_INLINE Fit fit_linear(const Moments& m) {
    Float8 a[3][3], b[3] = {m.f[0][1], m.f[1][0], m.f[0][0]};
    a[0][0] = m.of[0][2], a[0][1] = m.of[1][1], a[0][2] = m.of[0][1];
    a[1][1] = m.of[2][0], a[1][2] = m.of[1][0], a[2][2] = m.of[0][0];
    return eliminate<3>(a, b, m.count >= 6.0F);
}

struct Window {
    float radius, epsilon, noise;  ///< m, m, 1/m
    float fx, fy;                  ///< px
    bool quadratic;
};

/// θ by distance in pixels. Without AVX eight floats are aligned to 16 bytes only, but the loop
/// that is compiled for AVX takes 32 for granted.
struct alignas(32) Weights {
    Float8 of[kMostPixels + 1];
};

/// Smooths one row.
KINECTLAB_HOT_LOOP void smooth_row(
    const PaddedDepth& depth,
    int v,
    int width,
    const Window& window,
    Weights& all_weights,
    float* z_out,
    std::uint8_t* fitted
) {
    const float* centre = depth.row(v);
    Float8* const weights = all_weights.of;
    for (int u = 0; u < width; u += kLanes) {
        const Float8 read = load8(centre + u);
        const Mask8 valid = read > 0.0F;
        float nearest = std::numeric_limits<float>::infinity();
        for (int lane = 0; lane < kLanes; ++lane)
            if (valid[lane] != 0) nearest = std::min(nearest, read[lane]);
        if (!(nearest < std::numeric_limits<float>::infinity())) continue;

        const Float8 z0 = choose8(valid, read, all8(1.0F));
        const Float8 gate = window.radius + kNoiseSigmas * window.noise * z0 * z0;
        const int reach_u = static_cast<int>(window.radius * window.fx / nearest);
        const int reach_v = static_cast<int>(window.radius * window.fy / nearest);
        const float scale = 1.0F / static_cast<float>(std::max({reach_u, reach_v, 1}));

        // θ(d) = 1/(d² + ε²) by distance in pixels: the same in the window's four quarters.
        const Float8 metres = z0 * z0;
        const float squared_radius = window.radius * window.radius;
        Moments moments{};
        for (int dv = 0; dv <= reach_v; ++dv) {
            const float y = static_cast<float>(dv) / window.fy;
            const float y_at_nearest = y * nearest;
            const float chord = squared_radius - y_at_nearest * y_at_nearest;
            const int reach = std::min(
                reach_u, static_cast<int>(std::sqrt(std::max(chord, 0.0F)) * window.fx / nearest)
            );
            for (int du = 0; du <= reach; ++du) {
                const float x = static_cast<float>(du) / window.fx;
                const Float8 squared = metres * (x * x + y * y);
                const Float8 theta = 1.0F / (squared + window.epsilon * window.epsilon);
                weights[du] = keep8(theta, squared <= squared_radius);
            }
            const float far = static_cast<float>(dv) * scale;
            const float* below = depth.row(v + dv) + u;
            add_row(moments, below, reach, scale, far, z0, gate, weights);
            const float* above = depth.row(v - dv) + u;
            if (dv > 0) add_row(moments, above, reach, scale, -far, z0, gate, weights);
        }

        const Float8 mean = moments.f[0][0] / moments.of[0][0];
        const Fit linear = fit_linear(moments);
        Float8 f = choose8(linear.sound, linear.value, mean);
        Mask8 order = linear.sound & 1;
        if (window.quadratic) {
            const Fit quadratic = fit_quadratic(moments);
            f = choose8(quadratic.sound, quadratic.value, f);
            order = quadratic.sound ? Mask8{} + 2 : order;
        }
        const Float8 z = z0 + f;
        for (int lane = 0; lane < std::min(kLanes, width - u); ++lane) {
            if (valid[lane] == 0) continue;
            z_out[u + lane] = z[lane];
            fitted[u + lane] = static_cast<std::uint8_t>(order[lane]);
        }
    }
}

Result<void> check_picture(const Cloud& cloud, const Pinhole& camera, double radius_m) {
    if (auto right = check_shape(cloud); !right) return right;
    if (cloud.width != camera.width || cloud.height != camera.height)
        return fail(
            ErrorCode::bad_data,
            "cloud",
            "is " + std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                " points, but the camera has " + std::to_string(camera.width) + " x " +
                std::to_string(camera.height) + " pixels",
            "give the camera that the cloud was made with, or smooth it as an unorganised cloud"
        );
    float nearest = std::numeric_limits<float>::infinity();
    for (const float z : cloud.z)
        if (std::isfinite(z)) nearest = std::min(nearest, z);
    if (nearest <= 0.0F)
        return fail(
            ErrorCode::bad_data,
            "cloud",
            "has a point at z = " + number_text(nearest) + " m, which is not before the camera",
            "give points in the camera's frame, z forward"
        );
    const double pixels = radius_m * std::max(camera.fx, camera.fy) / nearest;
    if (std::isfinite(nearest) && pixels > kMostPixels)
        return fail(
            ErrorCode::invalid_argument,
            "radius_m",
            "is " + number_text(radius_m) + " m, which at the nearest point (" +
                number_text(nearest) + " m) is " + number_text(pixels) + " pixels",
            "give at most " + number_text(kMostPixels * nearest / std::max(camera.fx, camera.fy)) +
                " m"
        );
    return {};
}

}  // namespace

Result<Smoothed> smooth_organised(
    const Cloud& cloud, const Pinhole& camera, const MovingLeastSquaresSettings& settings
) {
    if (auto right = check(settings); !right) return tl::unexpected(right.error());
    if (auto right = check_picture(cloud, camera, settings.radius_m); !right)
        return tl::unexpected(right.error());

    Smoothed result{cloud, std::vector<std::uint8_t>(cloud.size(), Smoothed::kNoFit)};
    const PaddedDepth depth = pad(cloud, kMostPixels);
    const Window window{
        static_cast<float>(settings.radius_m),
        static_cast<float>(settings.epsilon_m),
        static_cast<float>(settings.depth_noise_per_m),
        static_cast<float>(camera.fx),
        static_cast<float>(camera.fy),
        settings.basis == Basis::quadratic};
    Weights weights;
    for (int v = 0; v < cloud.height; ++v) {
        const auto row = static_cast<std::ptrdiff_t>(v) * cloud.width;
        smooth_row(
            depth,
            v,
            cloud.width,
            window,
            weights,
            result.cloud.z.data() + row,
            result.fitted.data() + row
        );
    }
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (result.fitted[i] == Smoothed::kNoFit) continue;
        const float along = result.cloud.z[i] / cloud.z[i];
        result.cloud.x[i] *= along;
        result.cloud.y[i] *= along;
    }
    return result;
}

}  // namespace kinectlab
