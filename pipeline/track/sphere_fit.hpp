#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/disparity.hpp"
#include "pipeline/core/track_sample.hpp"
#include "pipeline/track/sphere_model.hpp"

namespace kinectlab {

/// A refined sphere and how well it explains the picture.
struct SphereFit {
    Sphere sphere;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the centre, m²
    double radius_u = 0.0;  ///< standard uncertainty of a free radius, m; 0 where it is known
    TrackQuality quality;
    double visible_share = 0.0;  ///< of the pixels that the sphere should cover, those that show it
    double alone_share = 0.0;  ///< of the pixels around its outline, those that show no more of it
};

/// Fits a sphere to a depth picture along the viewing rays, in disparity, where the noise is the
/// same for every pixel. That is maximum likelihood, so the centre is not pulled towards the camera
/// as by a fit of distances in space. Learns from picture to picture how far neighbouring pixels
/// err together, for the covariance. Keeps its buffers: no allocation after the constructor. Not
/// thread-safe.
class SphereFitter {
public:
    explicit SphereFitter(const RgbdCamera& camera);

    /// Starts from a guess within about a third of the radius. `fixed_radius`: the guess's radius
    /// is known and stays. Nothing if too few pixels carry the fit or it does not settle.
    [[nodiscard]] std::optional<SphereFit> fit(
        std::span<const std::uint16_t> depth, const Sphere& guess, bool fixed_radius
    );

private:
    struct Equations;
    struct Step {
        double gate_steps;   // residuals beyond do not count
        double rim_m;        // from the outline inwards, not used
        bool choose_pixels;  // anew, for the sphere as it is now
        bool fixed_radius;
    };
    void gather(std::span<const std::uint16_t> depth, const Sphere& sphere);
    [[nodiscard]] Equations equations(const Sphere& sphere, const Step& step);
    [[nodiscard]] bool settle(Sphere& sphere, Equations& sums, double sigma, bool fixed);
    void assess(SphereFit& fit, double sigma) const;
    [[nodiscard]] double correlation_inflation();
    [[nodiscard]] double lateral() const;
    void learn_lateral_noise(double sigma);

    struct Correlation {
        double of_blocks = 0.0;  // squares of the residuals' sums over blocks
        double of_pixels = 0.0;  // sums of the residuals' squares
    };

    struct LateralNoise {
        double excess = 0.0;    // of the residuals' variance, by slope²
        double leverage = 0.0;  // slope⁴
    };

    Pinhole camera_;
    DisparityScale scale_;
    LateralNoise lateral_;
    Correlation correlation_;
    int stride_ = 1;
    int columns_ = 0, rows_ = 0;    // of the gathered window
    std::vector<float> x_, y_, s_;  // ray and disparity of each pixel; s = 0 without a reading
    std::vector<float> used_, weight_, residual_, steep_;  // at the last linearisation
    std::array<std::vector<float>, 4> slope_;              // of the disparity by centre and radius
};

}  // namespace kinectlab
