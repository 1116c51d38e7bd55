#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/features/surface_points.hpp"
#include "pipeline/track/shape.hpp"

namespace kinectlab {

/// A refined shape and how surely it is known.
struct ShapeFit {
    /// A plane's point is the middle of what is seen of it, a cylinder's that of its seen length.
    Shape shape;
    /// Of shape.point (m²), then of the rotation vector (rad²), camera frame. What the shape does
    /// not show, the turn about its own axis, has the variance of an angle that may be anything,
    /// π²/3; of a sphere's rotation nothing is said (zero).
    Matrix6d covariance = Matrix6d::Zero();
    double size_u = 0.0;           ///< standard uncertainty of a free radius (m) or angle (rad)
    double low = 0.0, high = 0.0;  ///< cylinder and cone: seen from here to there along the axis, m
    TrackQuality quality;
    double cost = 1.0;  ///< mean of Tukey's loss over all pixels offered: 0 all on it, 1 none
};

/// Fits a shape to pixels along the viewing rays, in disparity, where the noise is the same for
/// every pixel: maximum likelihood for what is not an outlier. Learns from picture to picture how
/// far neighbouring pixels err together, for the covariance. Keeps its buffers: no allocation once
/// they have grown. Not thread-safe.
class ShapeFitter {
public:
    explicit ShapeFitter(const RgbdCamera& camera);

    /// Among `pixels` may be others than the shape's. A fixed size is known and stays. Nothing if
    /// too few pixels carry the fit, they do not determine the shape, or it does not settle.
    [[nodiscard]] std::optional<ShapeFit> fit(
        const DisparityImage& image,
        std::span<const std::uint32_t> pixels,
        const Shape& guess,
        bool fixed_size
    );

    static constexpr std::size_t kUnknowns = 6;

private:
    struct Equations;
    struct Way;
    void gather(const DisparityImage& image, std::span<const std::uint32_t> pixels);
    [[nodiscard]] double mean_sigma() const;
    std::optional<ShapeFit> fit_plane(const Shape& guess);
    std::optional<ShapeFit> fit_round(const Shape& guess, bool fixed_size);
    [[nodiscard]] bool settle(Shape& shape, Way& way, Equations& sums);
    void linearise(const Shape& shape, const Way& way);
    [[nodiscard]] Equations equations(const Way& way) const;
    void find_ends(const Shape& shape, double sigma, Way& way);
    [[nodiscard]] bool rim_is_sound(
        const Shape& shape, const Way& way, double wide_m, double sigma
    );
    void assess(ShapeFit& fit, double sigma) const;
    [[nodiscard]] double inflation(double sigma, double unknowns);

    Pinhole camera_;
    DisparityScale scale_;
    std::size_t offered_ = 0;       // pixels with a reading
    std::vector<float> x_, y_, s_;  // ray and disparity; padded with pixels that are not used
    std::vector<std::uint32_t> pixel_;
    std::vector<float> narrow_;
    std::vector<float> used_, weight_, residual_, height_;  // at the last linearisation
    std::array<std::vector<float>, kUnknowns> slope_;
    int block_columns_, block_rows_;
    std::vector<double> block_sum_, block_squares_;
    double of_blocks_ = 0.0, of_pixels_ = 0.0;  // fading sums for the correlation of neighbours
};

}  // namespace kinectlab
