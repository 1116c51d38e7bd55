#include "pipeline/simulate/room_picture.hpp"

#include <cmath>

#include "pipeline/simulate/shading.hpp"

namespace kinectlab::simulate {
namespace {

constexpr float kContrast = 0.05F;  ///< between samples; above it a pixel takes more

/// One camera on one room.
struct View {
    const Room& room;
    const Pinhole& camera;
    const Eigen::Isometry3d& T_lab_colour;

    [[nodiscard]] Radiance sample(double u, double v) const {
        const Eigen::Vector3d eye = T_lab_colour.translation();
        const Eigen::Vector3d ray = T_lab_colour.linear() * camera.ray(u, v);
        const Hit hit = room.cast(eye, ray);
        if (hit.material == Material::none) return Radiance::Zero();
        const double place_in_picture = 16.0 * (v * camera.width + u);
        const auto grain = static_cast<std::uint64_t>(std::llround(place_in_picture));
        return shade_room(room, hit, eye + hit.t * ray, eye, grain).cwiseMin(1.0F);
    }

    /// Mean of 4x4 samples.
    [[nodiscard]] Radiance fine_pixel(int u, int v) const {
        Radiance sum = Radiance::Zero();
        for (int i = 0; i < 16; ++i)
            sum += sample(u + (i % 4 - 1.5) / 4.0, v + (i / 4 - 1.5) / 4.0);
        return sum / 16.0F;
    }
};

/// Two samples a pixel on its diagonal, which meet any line half a pixel wide; sixteen where these
/// differ from each other or from a neighbour's.
std::vector<Radiance> sample_room(const View& view) {
    const auto width = static_cast<std::size_t>(view.camera.width);
    const std::size_t pixels = width * static_cast<std::size_t>(view.camera.height);
    const auto column = [width](std::size_t i) {
        return static_cast<int>(i % width);
    };
    const auto row = [width](std::size_t i) {
        return static_cast<int>(i / width);
    };
    std::vector<Radiance> mean(pixels);
    std::vector<bool> fine(pixels);
    const auto differ = [](const Radiance& a, const Radiance& b) {
        return (a - b).cwiseAbs().maxCoeff() > kContrast;
    };
    for (std::size_t i = 0; i < pixels; ++i) {
        const Radiance upper = view.sample(column(i) - 0.25, row(i) - 0.25);
        const Radiance lower = view.sample(column(i) + 0.25, row(i) + 0.25);
        mean[i] = 0.5F * (upper + lower);
        fine[i] = differ(upper, lower);
    }
    for (std::size_t i = 0; i < pixels; ++i) {
        for (const std::size_t next : {i + 1, i + width}) {
            if (next >= pixels || (next == i + 1 && column(next) == 0)) continue;
            if (differ(mean[i], mean[next])) fine[i] = fine[next] = true;
        }
    }
    for (std::size_t i = 0; i < pixels; ++i)
        if (fine[i]) mean[i] = view.fine_pixel(column(i), row(i));
    return mean;
}

}  // namespace

std::vector<std::uint8_t> picture_of_room(
    const Room& room, const Pinhole& camera, const Eigen::Isometry3d& T_lab_colour
) {
    std::vector<std::uint8_t> picture;
    picture.reserve(static_cast<std::size_t>(camera.width) * camera.height * 3);
    for (const Radiance& pixel : sample_room({room, camera, T_lab_colour}))
        for (const float channel : pixel)
            picture.push_back(to_srgb(channel));
    return picture;
}

}  // namespace kinectlab::simulate
