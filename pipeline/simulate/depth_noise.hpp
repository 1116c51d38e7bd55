#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/core/camera.hpp"
#include "pipeline/simulate/depth_caster.hpp"
#include "pipeline/simulate/noise_model.hpp"
#include "pipeline/simulate/random.hpp"

namespace kinectlab::simulate {

/// Makes of exact depth what a Kinect v1 delivers, in millimetres, 0 = no reading.
///
/// Disparity: 1/Z = 3 - 2.85e-3 d', σ = 0.5 before rounding (Khoshelham & Elberink 2012).
/// The model "kinect" adds
/// - noise shared by neighbours, as the correlation window does (a 5x5 pyramid holds 70 % of the
///   variance, the pixel itself 30 %);
/// - lateral noise: each pixel looks N(0, 0.6 px) aside (Nguyen, Izadi & Lovell 2012), so that
/// edges
///   are ragged, and gets no reading in a third of the cases where it looks across an edge;
/// - the projector's shadow: it stands 7.5 cm to the right, so what it cannot light lies left of
///   every near object (f = 580 px, Bohg et al. 2014);
/// - no reading where the surface is seen at a grazing angle, in the last 8 columns, nearer than
///   0.45 m, beyond 9.5 m, and in a few spots anywhere;
/// - a string that is thinner than a pixel: seen in patches, or spoiling its pixels, or invisible.
class DepthNoise {
public:
    DepthNoise(NoiseModel model, const Pinhole& camera, const ExactDepth& room);

    /// `depth_mm` gets width x height pixels.
    void apply(
        const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
    );

private:
    void apply_none(const ExactDepth& exact, std::vector<std::uint16_t>& depth_mm) const;
    void apply_khoshelham(
        const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
    ) const;
    void apply_kinect(
        const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
    );
    void look_at(const ExactDepth& exact, int top, int bottom);
    void kinect_row(const FrameRandom& random, int v, std::uint16_t* row_mm);
    void kinect_string(
        const ExactDepth& exact, const FrameRandom& random, std::vector<std::uint16_t>& depth_mm
    ) const;

    NoiseModel model_;
    int width_;
    int height_;
    double shadow_px_m_;             ///< baseline x focal length
    std::vector<std::uint16_t> mm_;  ///< by disparity step
    // What the kinect model keeps: 1/Z, negative where the projector's light does not come, with a
    // margin for the sideways look; and how often of 256 a pixel gets no reading.
    int stride_;
    std::vector<float> lit_;
    std::vector<std::uint8_t> missing_;
    std::vector<std::int32_t> aside_;    ///< sideways looks, ready as index offsets
    std::vector<float> smooth_;          ///< the Gaussian table after the horizontal pyramid
    std::vector<float> looked_, noise_;  ///< of one row
    std::vector<PixelRect> last_bodies_;
};

}  // namespace kinectlab::simulate
