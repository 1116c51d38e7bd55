#include "pipeline/simulate/colour_renderer.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/simulate/room_picture.hpp"
#include "pipeline/simulate/shading.hpp"

namespace kinectlab::simulate {
namespace {

constexpr double kBallGloss = 1.0;
constexpr double kBoxGloss = 0.2;
constexpr float kNoise = 1.7F;  ///< counts of 255

/// Bounds of a level square's picture, cut to the image; empty if it is not all in front.
PixelRect picture_of_square(
    const Pinhole& camera,
    const Eigen::Isometry3d& T_colour_lab,
    const Eigen::Vector3d& middle,
    double half_side
) {
    PixelRect rect{camera.width, camera.height, 0, 0};
    for (const double x : {-half_side, half_side}) {
        for (const double y : {-half_side, half_side}) {
            const Eigen::Vector3d corner = T_colour_lab * (middle + Eigen::Vector3d(x, y, 0.0));
            if (corner.z() < 0.05) return {};
            const Eigen::Vector2d uv = camera.project(corner);
            rect.left = std::min(rect.left, static_cast<int>(uv.x()));
            rect.top = std::min(rect.top, static_cast<int>(uv.y()));
            rect.right = std::max(rect.right, static_cast<int>(uv.x()) + 2);
            rect.bottom = std::max(rect.bottom, static_cast<int>(uv.y()) + 2);
        }
    }
    return {
        std::max(rect.left, 0),
        std::max(rect.top, 0),
        std::min(rect.right, camera.width),
        std::min(rect.bottom, camera.height)};
}

}  // namespace

ColourRenderer::ColourRenderer(
    const Room& room, const Pinhole& camera, const Eigen::Isometry3d& T_lab_colour
)
    : camera_(camera), T_lab_colour_(T_lab_colour), has_table_(room.has_table()) {
    room_ = picture_of_room(room, camera, T_lab_colour);
    now_ = room_;
}

void ColourRenderer::render(
    const MovingParts& moving, const FrameRandom& random, bool noisy, std::vector<std::uint8_t>& rgb
) {
    for (const PixelRect& rect : drawn_)
        restore(rect);
    drawn_.clear();
    if (has_table_)
        for (const Body& body : moving.bodies)
            draw_shadow(body.p_lab, ball_radius_of(body.shape));
    for (const Wire& wire : moving.wires)
        draw_string(wire);
    draw_bodies(moving.bodies);
    rgb.resize(now_.size());
    if (!noisy) {
        std::copy(now_.begin(), now_.end(), rgb.begin());
        return;
    }
    static const std::vector<std::int8_t> noise = [] {
        std::vector<std::int8_t> counts;
        for (const float gauss : gaussian_table())
            counts.push_back(static_cast<std::int8_t>(std::lround(kNoise * gauss)));
        return counts;
    }();
    constexpr std::uint32_t kColourPurpose = 100;
    const int row_bytes = camera_.width * 3;
    for (int v = 0; v < camera_.height; ++v) {
        const std::int8_t* add =
            noise.data() + place(random.draw(kColourPurpose, static_cast<std::uint32_t>(v)));
        const std::uint8_t* from = now_.data() + static_cast<std::ptrdiff_t>(v) * row_bytes;
        std::uint8_t* to = rgb.data() + static_cast<std::ptrdiff_t>(v) * row_bytes;
        for (int i = 0; i < row_bytes; ++i) {
            const auto sum = static_cast<std::int16_t>(from[i] + add[i]);
            to[i] = static_cast<std::uint8_t>(std::clamp(sum, std::int16_t{0}, std::int16_t{255}));
        }
    }
}

void ColourRenderer::restore(const PixelRect& rect) {
    for (int v = rect.top; v < rect.bottom; ++v) {
        const std::ptrdiff_t at = (static_cast<std::ptrdiff_t>(v) * camera_.width + rect.left) * 3;
        std::copy_n(room_.begin() + at, (rect.right - rect.left) * 3, now_.begin() + at);
    }
}

void ColourRenderer::blend(int u, int v, const Eigen::Vector3f& linear, float share) {
    std::uint8_t* pixel = now_.data() + (static_cast<std::ptrdiff_t>(v) * camera_.width + u) * 3;
    for (int i = 0; i < 3; ++i)
        pixel[i] = to_srgb(from_srgb(pixel[i]) + share * (linear[i] - from_srgb(pixel[i])));
}

/// The shadow falls on the table top; where it would miss it, the floor is out of sight or far.
void ColourRenderer::draw_shadow(const Eigen::Vector3d& centre, double radius) {
    const Eigen::Vector3d from_lamp = centre - lamp_centre();
    const double below = centre.z() - room::kTableTop;
    if (below <= 0.0 || from_lamp.z() >= 0.0) return;
    const Eigen::Vector3d middle = centre - below / from_lamp.z() * from_lamp;
    const double penumbra = kLampHalfSize * below / -from_lamp.z();
    const double reach = 2.5 * radius + 1.3 * penumbra + (middle - centre).head<2>().norm();
    const PixelRect rect = picture_of_square(camera_, T_lab_colour_.inverse(), middle, reach);
    const Eigen::Vector3d& eye = T_lab_colour_.translation();
    PixelRect drawn{rect.right, rect.bottom, rect.left, rect.top};
    for (int v = rect.top; v < rect.bottom; ++v) {
        for (int u = rect.left; u < rect.right; ++u) {
            const Eigen::Vector3d ray = T_lab_colour_.linear() * camera_.ray(u, v);
            if (ray.z() >= -1e-6) continue;
            const Eigen::Vector3d p = eye + (room::kTableTop - eye.z()) / ray.z() * ray;
            if (std::abs(p.x()) > room::kTableHalfX || std::abs(p.y()) > room::kTableHalfY)
                continue;
            const float left = light_left_by(centre, radius, p);
            std::uint8_t* pixel =
                now_.data() + (static_cast<std::ptrdiff_t>(v) * camera_.width + u) * 3;
            for (int i = 0; i < 3; ++i)
                pixel[i] = to_srgb(left * from_srgb(pixel[i]));
            drawn = {
                std::min(drawn.left, u),
                std::min(drawn.top, v),
                std::max(drawn.right, u + 1),
                std::max(drawn.bottom, v + 1)};
        }
    }
    if (!drawn.empty()) drawn_.push_back(drawn);
}

void ColourRenderer::draw_string(const Wire& wire) {
    const Eigen::Isometry3d T_colour_lab = T_lab_colour_.inverse();
    const Eigen::Vector3d from = T_colour_lab * wire.from_lab;
    const Eigen::Vector3d to = T_colour_lab * wire.to_lab;
    if (from.z() < 0.05 || to.z() < 0.05) return;
    const Eigen::Vector2d top = camera_.project(from);
    const Eigen::Vector2d bottom = camera_.project(to);
    if (bottom.y() - top.y() < 1.0) return;
    const double slope = (bottom.x() - top.x()) / (bottom.y() - top.y());
    const double lean = std::sqrt(1.0 + slope * slope);
    const int first = std::max(0, static_cast<int>(std::ceil(top.y())));
    const int last = std::min(camera_.height - 1, static_cast<int>(std::floor(bottom.y())));
    const Radiance colour = albedo(Material::string, wire.to_lab, Eigen::Vector3d::UnitZ());
    for (int v = first; v <= last; ++v) {
        const double share = (v - top.y()) / (bottom.y() - top.y());
        const double inverse_z = std::lerp(1.0 / from.z(), 1.0 / to.z(), share);
        const double half = room::kStringRadius * camera_.fx * inverse_z * lean;
        const double middle = top.x() + slope * (v - top.y());
        const int left = std::max(0, static_cast<int>(std::floor(middle - half)));
        const int right = std::min(camera_.width - 1, static_cast<int>(std::ceil(middle + half)));
        if (left > right) continue;
        for (int u = left; u <= right; ++u) {
            const double covered =
                std::min(u + 0.5, middle + half) - std::max(u - 0.5, middle - half);
            if (covered > 0.0) blend(u, v, colour, static_cast<float>(std::min(1.0, covered)));
        }
        drawn_.push_back({left, v, right + 1, v + 1});
    }
}

/// Far ones first, so that near ones hide them.
void ColourRenderer::draw_bodies(const std::vector<Body>& bodies) {
    const Eigen::Isometry3d T_colour_lab = T_lab_colour_.inverse();
    std::vector<const Body*> order;
    for (const Body& body : bodies)
        order.push_back(&body);
    const Eigen::Vector3d& eye = T_lab_colour_.translation();
    std::sort(order.begin(), order.end(), [&eye](const Body* a, const Body* b) {
        return (a->p_lab - eye).squaredNorm() > (b->p_lab - eye).squaredNorm();
    });
    for (const Body* body : order) {
        const PixelRect rect = picture_of(camera_, body->shape, T_cam_body_of(T_colour_lab, *body));
        if (rect.empty()) continue;
        if (std::holds_alternative<Cuboid>(body->shape))
            draw_box(*body, rect);
        else
            draw_sphere(*body, rect);
        drawn_.push_back(rect);
    }
}

void ColourRenderer::draw_sphere(const Body& body, const PixelRect& rect) {
    const double radius = std::get<Sphere>(body.shape).radius_m;
    const Eigen::Vector3d& eye = T_lab_colour_.translation();
    const Eigen::Vector3d centre = T_lab_colour_.inverse() * body.p_lab;
    const Eigen::Matrix3d R_body_lab = body.q_lab_body.toRotationMatrix().transpose();
    for (int v = rect.top; v < rect.bottom; ++v) {
        for (int u = rect.left; u < rect.right; ++u) {
            const Eigen::Vector3d ray = camera_.ray(u, v);
            const double rr = ray.squaredNorm();
            const double depth = ray.dot(centre) / rr;
            const Eigen::Vector3d nearest = depth * ray;
            const double off = (nearest - centre).norm();
            const double inside_px = (radius - off) * camera_.fx / depth;
            if (inside_px <= -0.5) continue;
            const double chord = std::sqrt(std::max(0.0, radius * radius - off * off));
            const Eigen::Vector3d point = nearest - chord / std::sqrt(rr) * ray;
            const Eigen::Vector3d normal = T_lab_colour_.linear() * (point - centre).normalized();
            const Eigen::Vector3d normal_body = R_body_lab * normal;
            const Radiance paint = paint_of(body.material, radius * normal_body, normal_body);
            const Radiance colour =
                shade_body(paint, kBallGloss, body.p_lab + radius * normal, normal, eye);
            blend(u, v, colour.cwiseMin(1.0F), static_cast<float>(std::min(1.0, inside_px + 0.5)));
        }
    }
}

/// Mean of 2x2 samples; those beside the box leave what is behind it.
void ColourRenderer::draw_box(const Body& body, const PixelRect& rect) {
    const Eigen::Vector3d half = 0.5 * std::get<Cuboid>(body.shape).size_m;
    const Eigen::Vector3d& eye = T_lab_colour_.translation();
    const Eigen::Matrix3d R_lab_body = body.q_lab_body.toRotationMatrix();
    const Eigen::Vector3d eye_body = R_lab_body.transpose() * (eye - body.p_lab);
    const Eigen::Matrix3d R_body_colour = R_lab_body.transpose() * T_lab_colour_.linear();
    for (int v = rect.top; v < rect.bottom; ++v) {
        for (int u = rect.left; u < rect.right; ++u) {
            Radiance sum = Radiance::Zero();
            int covered = 0;
            for (int i = 0; i < 4; ++i) {
                const Eigen::Vector3d ray =
                    R_body_colour * camera_.ray(u + (i % 2 - 0.5) / 2.0, v + (i / 2 - 0.5) / 2.0);
                const auto entry = enter_box(-half, half, eye_body, ray);
                if (!entry) continue;
                const Eigen::Vector3d normal = entry->sign * Eigen::Vector3d::Unit(entry->axis);
                const Eigen::Vector3d p = eye_body + entry->t * ray;
                const Radiance paint = paint_of(body.material, p, normal);
                sum += shade_body(
                    paint, kBoxGloss, body.p_lab + R_lab_body * p, R_lab_body * normal, eye
                );
                ++covered;
            }
            if (covered == 0) continue;
            const auto count = static_cast<float>(covered);
            blend(u, v, Radiance(sum / count).cwiseMin(1.0F), 0.25F * count);
        }
    }
}

}  // namespace kinectlab::simulate
