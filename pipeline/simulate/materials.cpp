#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/simulate/random.hpp"
#include "pipeline/simulate/shading.hpp"

namespace kinectlab::simulate {
namespace {

double lattice(std::int64_t x, std::int64_t y) {
    const auto draw =
        mix(static_cast<std::uint64_t>(x) * 0x9E3779B1ULL ^ mix(static_cast<std::uint64_t>(y)));
    return static_cast<double>(draw >> 11U) * 0x1.0p-53;
}

/// Smooth random field from 0 to 1, one wave a unit.
double value_noise(double x, double y) {
    const double fx = std::floor(x);
    const double fy = std::floor(y);
    const auto ix = static_cast<std::int64_t>(fx);
    const auto iy = static_cast<std::int64_t>(fy);
    const auto ease = [](double t) {
        return t * t * (3.0 - 2.0 * t);
    };
    const double sx = ease(x - fx);
    const double sy = ease(y - fy);
    return std::lerp(
        std::lerp(lattice(ix, iy), lattice(ix + 1, iy), sx),
        std::lerp(lattice(ix, iy + 1), lattice(ix + 1, iy + 1), sx),
        sy
    );
}

/// 1 on lines of this width around multiples of `spacing`, else 0.
double line(double coordinate, double spacing, double width) {
    const double off = std::abs(coordinate - spacing * std::round(coordinate / spacing));
    return off < 0.5 * width ? 1.0 : 0.0;
}

Radiance mixed(const Radiance& a, const Radiance& b, double share) {
    return a + static_cast<float>(share) * (b - a);
}

/// Planks along x, each with its own tone and grain.
Radiance wood(double along, double across, double plank_width) {
    const double plank = std::floor(across / plank_width);
    const double tone = lattice(static_cast<std::int64_t>(plank), 17);
    const double wave = value_noise(along * 1.7 + 31.0 * plank, across * 9.0);
    const double rings = 0.5 + 0.5 * std::sin(60.0 * (across + 0.10 * wave) + 5.0 * wave);
    const double fibre = value_noise(along * 9.0, across * 260.0);
    const Radiance light(0.50F, 0.285F, 0.135F);
    const Radiance dark(0.33F, 0.165F, 0.070F);
    Radiance colour = mixed(light, dark, 0.45 * rings + 0.35 * fibre + 0.25 * (tone - 0.5));
    const double seam = std::abs(across - plank_width * std::round(across / plank_width));
    return seam < 0.0012 ? Radiance(0.45F * colour) : colour;
}

/// A board of graph paper (10 cm squares, 50 cm bold) over a rule with marks at 2, 10 and 50 cm, in
/// a wooden frame.
Radiance board(double x, double z) {
    constexpr double kHalfWidth = 1.2;
    constexpr double kLow = 1.08;
    if (std::abs(x) > kHalfWidth || z < kLow) return wood(x, z, 0.5);
    if (z < kLow + 0.06) {
        const double height = z - kLow;
        const bool tick = (line(x, 0.02, 0.0034) > 0 && height > 0.045) ||
                          (line(x, 0.10, 0.0040) > 0 && height > 0.032) ||
                          (line(x, 0.50, 0.006) > 0 && height > 0.015);
        return tick ? Radiance(0.05F, 0.05F, 0.06F) : Radiance(0.86F, 0.73F, 0.36F);
    }
    const double fine = std::max(line(x, 0.1, 0.004), line(z - 0.9, 0.1, 0.004));
    const double bold = std::max(line(x, 0.5, 0.008), line(z - 0.9, 0.5, 0.008));
    const Radiance paper(0.80F, 0.83F, 0.82F);
    const Radiance ink(0.22F, 0.42F, 0.52F);
    return mixed(paper, ink, std::max(0.45 * fine, 0.75 * bold));
}

Radiance wall(double x, double z) {
    if (std::abs(x) < 1.235 && z > 1.045) return board(x, z);
    if (z < 0.09) return {0.55F, 0.54F, 0.52F};
    if (z > 0.93 && z < 0.975) return {0.70F, 0.69F, 0.66F};
    const double plaster = 0.97 + 0.05 * value_noise(x * 14.0, z * 14.0);
    const Radiance lower(0.27F, 0.38F, 0.41F);
    const Radiance upper(0.74F, 0.71F, 0.65F);
    return static_cast<float>(plaster) * (z < 0.95 ? lower : upper);
}

Radiance cabinet(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    const Radiance paint(0.60F, 0.60F, 0.57F);
    if (normal.y() > -0.5) return 0.95F * paint;
    const double seam = std::max(line(p.x() + 0.05, 0.42, 0.006), line(p.z() - 0.07, 0.46, 0.006));
    const double handle_x = std::abs(p.x() + 0.05 - 0.42 * std::round((p.x() + 0.05) / 0.42));
    const double handle_z = std::abs(p.z() - 0.76);
    if (handle_z < 0.05 && handle_x > 0.03 && handle_x < 0.045) return {0.12F, 0.12F, 0.13F};
    return mixed(paint, Radiance(0.15F, 0.15F, 0.15F), seam);
}

/// Six hues, and in each squares of a centimetre with tones of their own.
Radiance box_paint(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    static const std::array<Radiance, 6> hues = {
        Radiance(0.70F, 0.10F, 0.08F),
        Radiance(0.08F, 0.45F, 0.50F),
        Radiance(0.12F, 0.50F, 0.10F),
        Radiance(0.55F, 0.12F, 0.50F),
        Radiance(0.75F, 0.60F, 0.08F),
        Radiance(0.12F, 0.16F, 0.65F)};
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const auto face = static_cast<std::size_t>(2 * axis + (normal[axis] < 0.0 ? 1 : 0));
    constexpr double kSquare = 0.01;
    const double u = std::floor(p[(axis + 1) % 3] / kSquare);
    const double v = std::floor(p[(axis + 2) % 3] / kSquare);
    const double tone =
        lattice(static_cast<std::int64_t>(u), static_cast<std::int64_t>(v) + 1000 * (axis + 1));
    return static_cast<float>(0.35 + 0.65 * tone) * hues[face];
}

}  // namespace

Radiance albedo(Material material, const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    switch (material) {
        case Material::wall:
            return wall(p.x(), p.z());
        case Material::floor: {
            const double speckle = value_noise(p.x() * 70.0, p.y() * 70.0);
            return static_cast<float>(0.9 + 0.2 * speckle) * Radiance(0.30F, 0.29F, 0.28F);
        }
        case Material::table:
            return normal.z() > 0.5 ? wood(p.x(), p.y() + 0.4, 0.16) : wood(p.x(), p.z(), 0.5);
        case Material::table_leg:
            return wood(p.z(), p.x(), 0.5);
        case Material::cabinet:
            return cabinet(p, normal);
        case Material::mount:
            return {0.30F, 0.31F, 0.33F};
        case Material::string:
            return {0.05F, 0.05F, 0.055F};
        case Material::plank:
            return wood(p.x(), p.y() + 0.15, 0.30);
        case Material::sand: {
            const double speckle = value_noise(p.x() * 120.0, p.y() * 120.0 + 40.0 * p.z());
            return static_cast<float>(0.8 + 0.4 * speckle) * Radiance(0.42F, 0.34F, 0.22F);
        }
        default:
            return Radiance::Zero();
    }
}

Radiance paint_of(Material material, const Eigen::Vector3d& p, const Eigen::Vector3d& normal_body) {
    switch (material) {
        case Material::bob:
            return {0.66F, 0.022F, 0.035F};
        case Material::blue_ball:
            return {0.025F, 0.10F, 0.60F};
        case Material::yellow_ball:
            return {0.75F, 0.52F, 0.03F};
        case Material::striped_ball:
            return std::sin(4.0 * std::atan2(p.x(), p.z())) > 0.0 ? Radiance(0.70F, 0.20F, 0.02F)
                                                                  : Radiance(0.25F, 0.07F, 0.01F);
        case Material::painted_box:
            return box_paint(p, normal_body);
        default:
            return Radiance::Zero();
    }
}

}  // namespace kinectlab::simulate
