#pragma once

#include <optional>
#include <vector>

#include "pipeline/core/cloud.hpp"
#include "pipeline/preprocess/distance_kernels.hpp"

namespace kinectlab {

/// An organised cloud in which a metric radius becomes a window of pixels. The cloud itself tells
/// how far aside each column and row looks (x/z and y/z), so no camera needs to be known: all
/// points in the columns from c on lie behind the plane through the camera's centre with the least
/// x/z among them, and the distance to that plane is a bound that holds. Keeps its own padded copy
/// of the points. Thread-safe once made.
class PixelWindows {
public:
    /// Nothing if the cloud is not organised or not seen from one point: z of both signs or 0.
    [[nodiscard]] static std::optional<PixelWindows> of(const Cloud& cloud);

    /// Strips of the window about (u, v) that holds every point nearer than `radius` to the one
    /// there, without what its corners hold farther away.
    void fit(int u, int v, Point3 from, float radius, std::vector<Strip>& strips) const;

    /// The points that strips are cut from.
    [[nodiscard]] PointStrips points(std::span<const Strip> strips) const {
        return {x_.data(), y_.data(), z_.data(), stride_, strips};
    }

private:
    PixelWindows() = default;

    /// The plane that bounds what lies from a column (or row) on to one side.
    struct Side {
        float slope, scale, sine;
    };
    void find_sides(const Cloud& cloud);
    [[nodiscard]] static Side side_at(float slope);

    int width_ = 0, height_ = 0, stride_ = 0;
    float sign_x_ = 1, sign_y_ = 1, sign_z_ = 1;
    float columns_per_slope_ = 0, rows_per_slope_ = 0;  ///< nearly, for first guesses
    std::vector<float> x_, y_, z_;
    std::vector<Side> right_of_, left_of_, below_, above_;
};

}  // namespace kinectlab
