#include "pipeline/simulate/depth_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kinectlab::simulate {
namespace {

std::uint8_t grazing_of(double cosine) {
    const double angle = std::acos(std::clamp(cosine, 0.0, 1.0));
    return static_cast<std::uint8_t>(std::lround(255.0 * angle / (0.5 * std::numbers::pi)));
}

/// Distance of the lines o + s d (d not unit) and a + t e (e unit, 0 ≤ t ≤ length); true if they
/// pass within `radius`, and then s at the nearest approach.
bool meets_string(
    const Eigen::Vector3d& ray,
    const Eigen::Vector3d& from,
    const Eigen::Vector3d& along,
    double length,
    double& depth
) {
    const double rr = ray.squaredNorm();
    const double ra = ray.dot(along);
    const double rf = ray.dot(from);
    const double af = along.dot(from);
    const double below = rr - ra * ra;
    if (below < 1e-12) return false;
    const double t = std::clamp((ra * rf - rr * af) / below, 0.0, length);
    const Eigen::Vector3d point = from + t * along;
    depth = ray.dot(point) / rr;
    return depth > 0.0 &&
           (depth * ray - point).squaredNorm() < room::kStringRadius * room::kStringRadius;
}

int cut_to(double value, int limit) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
}

PixelRect picture_of_sphere(const Pinhole& camera, const Eigen::Vector3d& centre, double radius) {
    const double nearest = centre.z() - radius;
    if (nearest < 0.05) return {};
    const Eigen::Vector2d middle = camera.project(centre);
    // The outline leans outwards away from the axis; the factor bounds that.
    const double lean = std::hypot(centre.x(), centre.y()) / centre.z();
    const double reach_u = camera.fx * radius * (1.0 + lean) / nearest + 2.0;
    const double reach_v = camera.fy * radius * (1.0 + lean) / nearest + 2.0;
    return {
        cut_to(std::floor(middle.x() - reach_u), camera.width),
        cut_to(std::floor(middle.y() - reach_v), camera.height),
        cut_to(std::ceil(middle.x() + reach_u), camera.width),
        cut_to(std::ceil(middle.y() + reach_v), camera.height)};
}

/// A box's picture is the hull of its corners' pictures.
PixelRect picture_of_box(
    const Pinhole& camera, const Eigen::Vector3d& size, const Eigen::Isometry3d& T_cam_body
) {
    Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array2d high = -low;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Array3d side(
            corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5
        );
        const Eigen::Vector3d p = T_cam_body * Eigen::Vector3d(side * size.array());
        if (p.z() < 0.05) return {};
        const Eigen::Array2d uv = camera.project(p).array();
        low = low.min(uv);
        high = high.max(uv);
    }
    return {
        cut_to(std::floor(low.x()) - 1.0, camera.width),
        cut_to(std::floor(low.y()) - 1.0, camera.height),
        cut_to(std::ceil(high.x()) + 2.0, camera.width),
        cut_to(std::ceil(high.y()) + 2.0, camera.height)};
}

}  // namespace

PixelRect picture_of(
    const Pinhole& camera, const Shape& shape, const Eigen::Isometry3d& T_cam_body
) {
    if (const auto* box = std::get_if<Cuboid>(&shape))
        return picture_of_box(camera, box->size_m, T_cam_body);
    return picture_of_sphere(camera, T_cam_body.translation(), std::get<Sphere>(shape).radius_m);
}

Eigen::Isometry3d T_cam_body_of(const Eigen::Isometry3d& T_cam_lab, const Body& body) {
    Eigen::Isometry3d T_cam_body = Eigen::Isometry3d::Identity();
    T_cam_body.linear() = T_cam_lab.linear() * body.q_lab_body.toRotationMatrix();
    T_cam_body.translation() = T_cam_lab * body.p_lab;
    return T_cam_body;
}

DepthCaster::DepthCaster(
    const Room& room, const Pinhole& camera, const Eigen::Isometry3d& T_lab_cam
)
    : camera_(camera), T_cam_lab_(T_lab_cam.inverse()) {
    const auto pixels = static_cast<std::size_t>(camera.width) * camera.height;
    room_.inverse_depth.resize(pixels);
    room_.grazing.resize(pixels);
    std::size_t i = 0;
    for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u, ++i) {
            const Eigen::Vector3d ray = T_lab_cam.linear() * camera.ray(u, v);
            const Hit hit = room.cast(T_lab_cam.translation(), ray);
            const bool seen = hit.material != Material::none;
            room_.inverse_depth[i] = seen ? static_cast<float>(1.0 / hit.t) : 0.0F;
            room_.grazing[i] = seen ? grazing_of(-hit.normal.dot(ray) / ray.norm()) : 255;
        }
    }
    now_ = room_;
}

const ExactDepth& DepthCaster::cast(const MovingParts& moving) {
    for (const PixelRect& rect : now_.bodies)
        clear(rect);
    now_.bodies.clear();
    for (const Body& body : moving.bodies) {
        const Eigen::Isometry3d T_cam_body = T_cam_body_of(T_cam_lab_, body);
        const PixelRect rect = picture_of(camera_, body.shape, T_cam_body);
        now_.bodies.push_back(rect);
        if (const auto* box = std::get_if<Cuboid>(&body.shape))
            draw_box(rect, box->size_m, T_cam_body);
        else
            draw_sphere(rect, T_cam_body.translation(), std::get<Sphere>(body.shape).radius_m);
    }
    now_.string.clear();
    for (const Wire& wire : moving.wires)
        find_string(T_cam_lab_ * wire.from_lab, T_cam_lab_ * wire.to_lab);
    return now_;
}

void DepthCaster::clear(const PixelRect& rect) {
    for (int v = rect.top; v < rect.bottom; ++v) {
        const std::ptrdiff_t begin = static_cast<std::ptrdiff_t>(v) * camera_.width + rect.left;
        const std::ptrdiff_t count = rect.right - rect.left;
        std::copy_n(room_.inverse_depth.begin() + begin, count, now_.inverse_depth.begin() + begin);
        std::copy_n(room_.grazing.begin() + begin, count, now_.grazing.begin() + begin);
    }
}

void DepthCaster::draw(int u, int v, double depth, double facing) {
    const auto i = static_cast<std::size_t>(v) * camera_.width + u;
    if (1.0 / depth <= now_.inverse_depth[i]) return;
    now_.inverse_depth[i] = static_cast<float>(1.0 / depth);
    now_.grazing[i] = grazing_of(facing);
}

void DepthCaster::draw_sphere(const PixelRect& rect, const Eigen::Vector3d& centre, double radius) {
    const double beyond = centre.squaredNorm() - radius * radius;
    for (int v = rect.top; v < rect.bottom; ++v) {
        for (int u = rect.left; u < rect.right; ++u) {
            const Eigen::Vector3d ray = camera_.ray(u, v);
            const double rr = ray.squaredNorm();
            const double towards = ray.dot(centre);
            const double inside = towards * towards - rr * beyond;
            if (inside <= 0.0) continue;
            const double depth = (towards - std::sqrt(inside)) / rr;
            const Eigen::Vector3d normal = (depth * ray - centre) / radius;
            draw(u, v, depth, -normal.dot(ray) / std::sqrt(rr));
        }
    }
}

void DepthCaster::draw_box(
    const PixelRect& rect, const Eigen::Vector3d& size, const Eigen::Isometry3d& T_cam_body
) {
    const Eigen::Isometry3d T_body_cam = T_cam_body.inverse();
    const Eigen::Vector3d half = 0.5 * size;
    for (int v = rect.top; v < rect.bottom; ++v) {
        for (int u = rect.left; u < rect.right; ++u) {
            const Eigen::Vector3d ray = T_body_cam.linear() * camera_.ray(u, v);
            const auto entry = enter_box(-half, half, T_body_cam.translation(), ray);
            if (!entry || entry->t <= 0.0) continue;
            draw(u, v, entry->t, std::abs(ray[entry->axis]) / ray.norm());
        }
    }
}

void DepthCaster::find_string(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    if (from.z() < 0.05 || to.z() < 0.05) return;
    const double length = (to - from).norm();
    const Eigen::Vector3d along = (to - from) / length;
    const Eigen::Vector2d top = camera_.project(from);
    const Eigen::Vector2d bottom = camera_.project(to);
    const double rise = bottom.y() - top.y();
    if (rise < 1e-6) return;
    const double slope = (bottom.x() - top.x()) / rise;
    const double reach = 0.5 * std::abs(slope) + 1.5;
    const int first = std::max(0, static_cast<int>(std::floor(top.y())));
    const int last = std::min(camera_.height - 1, static_cast<int>(std::ceil(bottom.y())));
    for (int v = first; v <= last; ++v) {
        const double middle = top.x() + slope * (v - top.y());
        const int left = std::max(0, static_cast<int>(std::ceil(middle - reach)));
        const int right = std::min(camera_.width - 1, static_cast<int>(std::floor(middle + reach)));
        for (int u = left; u <= right; ++u) {
            double depth = 0.0;
            if (!meets_string(camera_.ray(u, v), from, along, length, depth)) continue;
            const auto i = static_cast<std::size_t>(v) * camera_.width + u;
            const auto inverse = static_cast<float>(1.0 / depth);
            if (inverse > now_.inverse_depth[i]) now_.string.push_back({u, v, inverse});
        }
    }
}

}  // namespace kinectlab::simulate
