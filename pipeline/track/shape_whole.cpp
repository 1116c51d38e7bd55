#include "pipeline/track/shape_whole.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr double kMostSeenThrough = 0.2;  // of the rays that tell: cans and mugs show up to 0.1
constexpr double kRimPx = 1.5;            // a sensor's outlines are this unsure
constexpr double kRimOfSize = 0.1;        // and the fit's own, where much is left out
constexpr double kNearest_m = 0.05;       // to the camera: what reaches there may fill the picture

/// Rays that meet it meet the shape, well inside its outline.
Shape slimmer(const Shape& shape, double rim_m) {
    Shape slim = shape;
    if (shape.kind == ShapeKind::cone)
        slim.point += rim_m / std::sin(shape.size) * shape.axis;
    else
        slim.size =
            std::max(0.5 * shape.size, shape.size - std::max(rim_m, kRimOfSize * shape.size));
    return slim;
}

/// Half the width of what is seen of a cone, where it is widest.
double across(const ShapeFit& fit) {
    return fit.high * std::tan(fit.shape.size);
}

struct Window {
    int left, right, top, bottom;  // px, inclusive
};

/// Where a ball around the shape's seen length may be in the picture.
Window window_of(const ShapeFit& fit, const Pinhole& camera) {
    const Shape& shape = fit.shape;
    Eigen::Vector3d middle = shape.point;
    double reach = shape.size;
    if (shape.kind != ShapeKind::sphere) {
        middle += 0.5 * (fit.low + fit.high) * shape.axis;
        const double half = shape.kind == ShapeKind::cone ? across(fit) : shape.size;
        reach = std::hypot(0.5 * (fit.high - fit.low), half);
    }
    const double near = middle.z() - reach, far = middle.z() + reach;
    if (!(near > kNearest_m)) return {0, camera.width - 1, 0, camera.height - 1};
    const auto bound = [&](double at, double focal, double centre, int size) {
        const double least = at - reach, most = at + reach;
        const double low = focal * least / (least < 0.0 ? near : far) + centre;
        const double high = focal * most / (most < 0.0 ? far : near) + centre;
        const double last = size - 1;
        return std::pair(
            static_cast<int>(std::clamp(std::floor(low), 0.0, last)),
            static_cast<int>(std::clamp(std::ceil(high), 0.0, last))
        );
    };
    const auto [left, right] = bound(middle.x(), camera.fx, camera.cx, camera.width);
    const auto [top, bottom] = bound(middle.y(), camera.fy, camera.cy, camera.height);
    return {left, right, top, bottom};
}

}  // namespace

bool is_whole(
    const ShapeFit& fit,
    const DisparityImage& image,
    const Pinhole& camera,
    const DisparityScale& scale,
    double most_rays,
    double most_sunk
) {
    const Shape& shape = fit.shape;
    if (shape.kind == ShapeKind::plane) return true;
    const Shape slim = slimmer(shape, kRimPx * shape.point.norm() / camera.fx);
    const Window window = window_of(fit, camera);
    const double area = (window.right - window.left + 1.0) * (window.bottom - window.top + 1.0);
    const int stride = 1 + static_cast<int>(std::sqrt(area / most_rays));
    const double depth_m = shape.kind == ShapeKind::cone ? across(fit) : shape.size;
    double on = 0.0, through = 0.0, sunk = 0.0;
    for (int v = window.top; v <= window.bottom; v += stride)
        for (int u = window.left; u <= window.right; u += stride) {
            const double s = image.row(v)[u];
            if (s <= 0.0) continue;
            const Eigen::Vector3d ray = camera.ray(u, v);
            const double w = meet(ray, shape);
            if (!(w > 0.0) || !(meet(ray, slim) > 0.0)) continue;
            const double height = height_on(shape, ray / w);
            if (shape.kind != ShapeKind::sphere && (height < fit.low || height > fit.high))
                continue;
            const double off = (s - w / scale.inverse_depth_step) / scale.sigma_at(s);
            on += std::abs(off) <= kLastGateSigmas ? 1.0 : 0.0;
            through += off < -kLastGateSigmas ? 1.0 : 0.0;
            sunk += off > kLastGateSigmas && 1.0 / w - scale.metres(s) < depth_m ? 1.0 : 0.0;
        }
    return through <= kMostSeenThrough * (on + through) && sunk <= most_sunk * (on + sunk);
}

}  // namespace kinectlab
