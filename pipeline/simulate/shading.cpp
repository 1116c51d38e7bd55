#include "pipeline/simulate/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/simulate/random.hpp"

namespace kinectlab::simulate {
namespace {

constexpr double kLampPower = 4.4;
constexpr int kLampSamples = 6;
constexpr float kExposure = 1.12F;

/// Schlick 1994.
double fresnel(double cosine, double head_on) {
    return head_on + (1.0 - head_on) * std::pow(1.0 - std::clamp(cosine, 0.0, 1.0), 5.0);
}

/// The share of the lamp that a point sees.
double lamp_share(const Room& room, const Eigen::Vector3d& p, std::uint64_t grain) {
    if (p.z() > room::kTallestFurniture) return 1.0;
    int seen = 0;
    for (int i = 0; i < kLampSamples; ++i) {
        const std::uint64_t draw = mix(grain + static_cast<std::uint64_t>(i));
        const double x = static_cast<double>(draw >> 40U) * 0x1.0p-23 - 1.0;
        const double y = static_cast<double>(draw & 0xFFFFFFU) * 0x1.0p-23 - 1.0;
        seen += room.hides(p, lamp_centre() + kLampHalfSize * Eigen::Vector3d(x, y, 0.0)) ? 0 : 1;
    }
    return static_cast<double>(seen) / kLampSamples;
}

/// Corners and the room under the table are darker.
double openness(const Room& room, const Hit& hit, const Eigen::Vector3d& p) {
    double open = 1.0;
    if (hit.material == Material::floor)
        open *= 1.0 - 0.5 * std::exp(-(room::kWallY - p.y()) / 0.12);
    if (hit.material == Material::wall) open *= 1.0 - 0.35 * std::exp(-p.z() / 0.10);
    if (!room.has_table()) return open;
    const double under_x = room::kTableHalfX + 0.1 - std::abs(p.x());
    const double under_y = room::kTableHalfY + 0.15 - std::abs(p.y());
    if (p.z() < room::kTableTop - 0.045 && under_x > 0.0 && under_y > 0.0)
        open *= 1.0 - 0.65 * std::min(1.0, 6.0 * std::min(under_x, under_y));
    return open;
}

}  // namespace

Eigen::Vector3d lamp_centre() {
    return {-0.55, -0.75, 2.75};
}

Irradiance irradiance(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d to_lamp = lamp_centre() - p;
    const double distance = to_lamp.norm();
    const double facing = std::max(0.0, normal.dot(to_lamp) / distance);
    const double emitting = std::max(0.0, to_lamp.z() / distance) * 0.6 + 0.4;
    const double up = 0.5 + 0.5 * normal.z();
    const double left = 0.5 - 0.5 * normal.x();
    Irradiance light;
    light.direct = static_cast<float>(kLampPower * facing * emitting / (distance * distance)) *
                   Radiance(1.0F, 0.965F, 0.90F);
    light.ambient = static_cast<float>(up) * Radiance(0.40F, 0.42F, 0.45F) +
                    static_cast<float>(1.0 - up) * Radiance(0.26F, 0.22F, 0.18F) +
                    static_cast<float>(left) * Radiance(0.06F, 0.07F, 0.09F);
    return light;
}

Radiance shade_room(
    const Room& room,
    const Hit& hit,
    const Eigen::Vector3d& p,
    const Eigen::Vector3d& eye,
    std::uint64_t grain
) {
    const Irradiance light = irradiance(p, hit.normal);
    const double share = light.direct.x() > 0.0F ? lamp_share(room, p, grain) : 0.0;
    const Radiance arriving = static_cast<float>(share) * light.direct +
                              static_cast<float>(openness(room, hit, p)) * light.ambient;
    Radiance leaving = albedo(hit.material, p, hit.normal).cwiseProduct(arriving);
    if (hit.material == Material::table || hit.material == Material::floor) {
        // A coat of varnish mirrors the wall where one looks at it flatly.
        const double cosine = hit.normal.dot((eye - p).normalized());
        const double mirror = hit.material == Material::table ? fresnel(cosine, 0.04) : 0.03;
        leaving += static_cast<float>(0.55 * mirror * openness(room, hit, p)) *
                   Radiance(0.50F, 0.55F, 0.57F);
    }
    return kExposure * leaving;
}

Radiance shade_body(
    const Radiance& paint,
    double gloss,
    const Eigen::Vector3d& p,
    const Eigen::Vector3d& normal,
    const Eigen::Vector3d& eye
) {
    const Irradiance light = irradiance(p, normal);
    const Eigen::Vector3d view = (eye - p).normalized();
    const Eigen::Vector3d mirrored = 2.0 * normal.dot(view) * normal - view;
    const double mirror = fresnel(normal.dot(view), 0.05);
    // What the mirrored ray meets: the lamp's square with soft rims, the bright room, or the table.
    Radiance around =
        mirrored.z() > 0.0 ? Radiance(0.55F, 0.57F, 0.60F) : Radiance(0.30F, 0.18F, 0.09F);
    if (mirrored.z() > 0.05) {
        const Eigen::Vector3d on_lamp =
            p + (lamp_centre().z() - p.z()) / mirrored.z() * mirrored - lamp_centre();
        const double off = std::max(std::abs(on_lamp.x()), std::abs(on_lamp.y())) / kLampHalfSize;
        around += static_cast<float>(14.0 * std::clamp(1.8 - off, 0.0, 1.0)) * Radiance::Ones();
    }
    return kExposure * (paint.cwiseProduct(light.direct + light.ambient) +
                        static_cast<float>(gloss * mirror) * around);
}

float light_left_by(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& p) {
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const Irradiance light = irradiance(p, up);
    const Eigen::Vector3d to_lamp = lamp_centre() - p;
    const Eigen::Vector3d to_bob = centre - p;
    const double along = to_bob.dot(to_lamp) / to_lamp.norm();
    double hidden = 0.0;
    if (along > 0.0 && along < to_lamp.norm()) {
        const double off = std::sqrt(std::max(0.0, to_bob.squaredNorm() - along * along));
        const double penumbra = kLampHalfSize * along / (to_lamp.norm() - along);
        const double t = std::clamp((radius + penumbra - off) / (2.0 * penumbra), 0.0, 1.0);
        const double deepest = std::min(1.0, radius * radius / (penumbra * penumbra));
        hidden = deepest * t * t * (3.0 - 2.0 * t);
    }
    const double near = radius * radius / to_bob.squaredNorm();
    const double closed = near * std::max(0.0, to_bob.z() / to_bob.norm());
    const float direct = light.direct.sum();
    const float ambient = light.ambient.sum();
    return (direct * static_cast<float>(1.0 - hidden) + ambient * static_cast<float>(1.0 - closed)
           ) /
           (direct + ambient);
}

std::uint8_t to_srgb(float linear) {
    static const std::array<std::uint8_t, 4096> table = [] {
        std::array<std::uint8_t, 4096> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double x = static_cast<double>(i) / (values.size() - 1);
            const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
            values[i] = static_cast<std::uint8_t>(std::lround(255.0 * y));
        }
        return values;
    }();
    return table[static_cast<std::size_t>(std::clamp(linear, 0.0F, 1.0F) * 4095.0F + 0.5F)];
}

float from_srgb(std::uint8_t value) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double y = static_cast<double>(i) / 255.0;
            const double x = y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
            values[i] = static_cast<float>(x);
        }
        return values;
    }();
    return table[value];
}

}  // namespace kinectlab::simulate
