#include "pipeline/features/surface_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/core/hot_loop.hpp"
#include "pipeline/core/vector8.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // eight floats are passed to inlined functions only

namespace kinectlab {
namespace {

constexpr float kMaxJumpSteps = 12.0F;  // a table seen flat falls by one a pixel
constexpr double kMaxRmsSigmas = 2.5;   // of the readings about their plane

KINECTLAB_HOT_LOOP void to_steps(const std::uint16_t* depth, int n, float product, float* steps) {
    for (int i = 0; i < n; ++i) {
        const auto counts = static_cast<float>(depth[i]);
        steps[i] = depth[i] == 0 ? 0.0F : product / counts;
    }
}

/// Sums over a window about its middle: the moments of the places, and of s with each.
struct Window {
    float n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0, s = 0, su = 0, sv = 0, ss = 0;
};

KINECTLAB_HOT_LOOP Window sum_window(const float* middle, std::ptrdiff_t stride, int half) {
    const Float8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
    const float s0 = *middle;
    const auto reach = static_cast<float>(half);
    Float8 n{}, mu{}, mv{}, muu{}, muv{}, mvv{}, ms{}, msu{}, msv{}, mss{};
    for (int dv = -half; dv <= half; ++dv) {
        const float* row = middle + dv * stride;
        const auto y = static_cast<float>(dv);
        for (int du = -half; du <= half; du += 8) {
            const Float8 x = lanes + static_cast<float>(du);
            const Float8 read = load8(row + du);
            const Float8 off = read - s0;
            const Mask8 in = (abs8(off) <= kMaxJumpSteps) & (read > 0.0F) & (x <= reach);
            const Float8 one = keep8(all8(1.0F), in);
            const Float8 s = keep8(off, in);
            const Float8 ox = x * one;
            n += one;
            mu += ox;
            mv += one * y;
            muu += ox * x;
            muv += ox * y;
            mvv += one * (y * y);
            ms += s;
            msu += s * x;
            msv += s * y;
            mss += s * s;
        }
    }
    Window sums;
    for (int lane = 0; lane < 8; ++lane) {
        sums.n += n[lane], sums.u += mu[lane], sums.v += mv[lane];
        sums.uu += muu[lane], sums.uv += muv[lane], sums.vv += mvv[lane];
        sums.s += ms[lane], sums.su += msu[lane], sums.sv += msv[lane], sums.ss += mss[lane];
    }
    return sums;
}

struct LocalPlane {
    float a, b, c;  // s - s0 = a du + b dv + c
    float rms;
};

bool solve(const Window& w, int half, LocalPlane& plane) {
    const auto side = static_cast<float>(2 * half + 1);
    if (2.0F * w.n < side * side) return false;
    const float per_n = 1.0F / w.n;
    const float uu = w.uu - w.u * w.u * per_n, uv = w.uv - w.u * w.v * per_n;
    const float vv = w.vv - w.v * w.v * per_n;
    const float su = w.su - w.s * w.u * per_n, sv = w.sv - w.s * w.v * per_n;
    const float ss = w.ss - w.s * w.s * per_n;
    const float determinant = uu * vv - uv * uv;
    if (!(determinant > 0.05F * uu * vv)) return false;
    plane.a = (su * vv - sv * uv) / determinant;
    plane.b = (sv * uu - su * uv) / determinant;
    plane.c = (w.s - plane.a * w.u - plane.b * w.v) * per_n;
    plane.rms = std::sqrt(std::max(0.0F, ss - plane.a * su - plane.b * sv) * per_n);
    return true;
}

}  // namespace

DisparityImage::DisparityImage(const RgbdCamera& camera)
    : width_(camera.depth.width),
      height_(camera.depth.height),
      stride_(camera.depth.width + 2 * kMargin),
      product_(static_cast<float>(DisparityScale(camera).product)),
      steps_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 2 * kMargin)) {}

void DisparityImage::load_box(
    std::span<const std::uint16_t> depth, int left, int right, int top, int bottom
) {
    left = std::max(0, left), right = std::min(right, width_ - 1);
    top = std::max(0, top), bottom = std::min(bottom, height_ - 1);
    for (int v = top; v <= bottom; ++v) {
        const auto* from = depth.data() + static_cast<std::ptrdiff_t>(v) * width_ + left;
        to_steps(from, right - left + 1, product_, const_cast<float*>(row(v)) + left);
    }
}

void DisparityImage::load(std::span<const std::uint16_t> depth, int first_row, int last_row) {
    load_box(depth, 0, width_ - 1, first_row, last_row);
}

void DisparityImage::load_around(
    std::span<const std::uint16_t> depth, std::span<const std::uint32_t> pixels
) {
    const auto width = static_cast<std::uint32_t>(width_);
    std::uint32_t left = width, right = 0, top = static_cast<std::uint32_t>(height_), bottom = 0;
    std::uint32_t row_begin = 0, row_end = 0;  // neighbours in the list share a row
    for (const auto pixel : pixels) {
        if (pixel < row_begin || pixel >= row_end) {
            const std::uint32_t row = pixel / width;
            row_begin = row * width;
            row_end = row_begin + width;
            top = std::min(top, row);
            bottom = std::max(bottom, row);
        }
        left = std::min(left, pixel - row_begin);
        right = std::max(right, pixel - row_begin);
    }
    if (pixels.empty()) return;
    const auto margin = kMostHalfWindow + 8;  // windows are read in eights
    load_box(
        depth,
        static_cast<int>(left) - margin,
        static_cast<int>(right) + margin,
        static_cast<int>(top) - margin,
        static_cast<int>(bottom) + margin
    );
}

void SurfacePoints::clear() {
    for (auto* field : {&px, &py, &pz, &nx, &ny, &nz, &sigma})
        field->clear();
    pixel.clear();
    size = 0;
}

void SurfacePoints::reserve(std::size_t points) {
    for (auto* field : {&px, &py, &pz, &nx, &ny, &nz, &sigma})
        field->reserve(points + kLanes);
    pixel.reserve(points + kLanes);
}

void SurfacePoints::pad() {
    const std::size_t padded = (size + kLanes - 1) / kLanes * kLanes;
    for (auto* field : {&px, &py, &pz, &nx, &ny, &nz, &sigma})
        field->resize(padded, std::numeric_limits<float>::quiet_NaN());
    pixel.resize(padded, 0);
}

void SurfacePoints::copy(const SurfacePoints& other, std::size_t i) {
    px.push_back(other.px[i]), py.push_back(other.py[i]), pz.push_back(other.pz[i]);
    nx.push_back(other.nx[i]), ny.push_back(other.ny[i]), nz.push_back(other.nz[i]);
    sigma.push_back(other.sigma[i]);
    pixel.push_back(other.pixel[i]);
    ++size;
}

OrientedPoint SurfacePoints::at(std::size_t i) const {
    return {{px[i], py[i], pz[i]}, {nx[i], ny[i], nz[i]}, 0.0};
}

void find_surface_points(
    const DisparityImage& image,
    const RgbdCamera& camera,
    std::span<const std::uint32_t> pixels,
    int half_window,
    SurfacePoints& points
) {
    const DisparityScale scale(camera);
    const int half = std::clamp(half_window, 1, DisparityImage::kMostHalfWindow);
    const auto width = static_cast<std::uint32_t>(camera.depth.width);
    const std::ptrdiff_t stride = image.row(1) - image.row(0);
    points.clear();
    for (const std::uint32_t pixel : pixels) {
        const int u = static_cast<int>(pixel % width), v = static_cast<int>(pixel / width);
        const float* middle = image.row(v) + u;
        if (*middle == 0.0F) continue;
        LocalPlane plane{};
        if (!solve(sum_window(middle, stride, half), half, plane)) continue;

        // s = k·(n/d)·((u-cx)/fx, (v-cy)/fy, 1) compared with the slopes in the picture.
        const Eigen::Vector3d ray = camera.depth.ray(u, v);
        const double s = static_cast<double>(*middle) + plane.c;
        const double sigma = scale.sigma_at(s);
        if (!(s > 0.0) || plane.rms > kMaxRmsSigmas * sigma) continue;
        Eigen::Vector3d normal(plane.a * camera.depth.fx, plane.b * camera.depth.fy, 0.0);
        normal.z() = s - normal.x() * ray.x() - normal.y() * ray.y();
        normal.normalize();
        double cosine = normal.dot(ray);
        if (cosine > 0.0) normal = -normal;
        cosine = std::abs(cosine);
        const double z = scale.metres(s);
        points.px.push_back(static_cast<float>(ray.x() * z));
        points.py.push_back(static_cast<float>(ray.y() * z));
        points.pz.push_back(static_cast<float>(z));
        points.nx.push_back(static_cast<float>(normal.x()));
        points.ny.push_back(static_cast<float>(normal.y()));
        points.nz.push_back(static_cast<float>(normal.z()));
        points.sigma.push_back(static_cast<float>(sigma * z / s * cosine));
        points.pixel.push_back(pixel);
        ++points.size;
    }
    points.pad();
}

}  // namespace kinectlab
