#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/frame.hpp"

namespace kinectlab {

/// Points in metres, camera frame unless its owner says otherwise; a structure of arrays, so that
/// loops read only what they need. A point without a reading is NaN in x, y and z.
/// Organised: row-major as the pixels of a picture. From anywhere else: height 1.
struct Cloud {
    int width = 0;
    int height = 0;
    std::vector<float> x, y, z;     ///< m, width x height each
    std::vector<std::uint8_t> rgb;  ///< 3 bytes a point; empty if there is no colour

    [[nodiscard]] std::size_t size() const { return x.size(); }
    [[nodiscard]] bool organised() const { return width > 1 && height > 1; }
    [[nodiscard]] bool valid(std::size_t i) const {
        return std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i]);
    }
};

/// All points without a reading.
[[nodiscard]] inline Cloud blank_cloud(int width, int height) {
    Cloud cloud{width, height, {}, {}, {}, {}};
    const auto points = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (auto* axis : {&cloud.x, &cloud.y, &cloud.z})
        axis->assign(points, std::numeric_limits<float>::quiet_NaN());
    return cloud;
}

/// An error if the arrays do not have width x height points.
[[nodiscard]] inline Result<void> check_shape(const Cloud& cloud) {
    const auto points = static_cast<std::size_t>(std::max(cloud.width, 0)) *
                        static_cast<std::size_t>(std::max(cloud.height, 0));
    const bool coloured = cloud.rgb.empty() || cloud.rgb.size() == 3 * points;
    if (cloud.x.size() == points && cloud.y.size() == points && cloud.z.size() == points &&
        coloured)
        return {};
    return fail(
        ErrorCode::bad_data,
        "cloud",
        "is said to be " + std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
            " points but holds " + std::to_string(cloud.x.size()) + ", " +
            std::to_string(cloud.y.size()) + " and " + std::to_string(cloud.z.size()) +
            " coordinates and " + std::to_string(cloud.rgb.size()) + " bytes of colour",
        "x, y and z of width x height points, rgb of none or three bytes for each"
    );
}

/// The organised cloud of a depth picture. `frame.depth` has the camera's width x height counts of
/// `unit_m`; 0 becomes NaN. The colour goes along only where it has as many pixels: whoever has a
/// colour camera that looks through another hole registers first.
[[nodiscard]] inline Cloud cloud_from(
    const RgbdFrame& frame, const Pinhole& camera, double unit_m = 0.001
) {
    Cloud cloud = blank_cloud(camera.width, camera.height);
    const auto unit = static_cast<float>(unit_m);
    for (int v = 0; v < camera.height; ++v) {
        const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width);
        const auto slope_y = static_cast<float>((v - camera.cy) / camera.fy);
        for (int u = 0; u < camera.width; ++u) {
            const std::size_t i = row + static_cast<std::size_t>(u);
            const std::uint16_t counts = frame.depth[i];
            if (counts == 0) continue;
            const float z = unit * static_cast<float>(counts);
            cloud.x[i] = static_cast<float>((u - camera.cx) / camera.fx) * z;
            cloud.y[i] = slope_y * z;
            cloud.z[i] = z;
        }
    }
    if (frame.rgb.size() == 3 * cloud.size()) cloud.rgb = frame.rgb;
    return cloud;
}

}  // namespace kinectlab
