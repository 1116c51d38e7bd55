#include "pipeline/track/model_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kinectlab {
namespace {

constexpr double kNoiseSigmas = 2.5;
constexpr double kMeshFault_m = 0.003;  // models and sensors are no better than this
constexpr double kHidesSigmas = 8.0;    // nearer by so much is something else
constexpr double kLeastSlant = 0.35;    // cosine between a face's normal and the view
constexpr std::array kBeyond_px = {4.0, 6.0};

/// By how many tolerances a pixel reads nearer than a plane through `p` with the normal `n`; none
/// without a reading, out of the picture or where its ray does not meet the plane.
std::optional<double> off_plane(
    std::span<const std::uint16_t> depth,
    const Pinhole& lens,
    const DisparityScale& scale,
    const Eigen::Vector2d& at,
    const Eigen::Vector3d& p,
    const Eigen::Vector3d& n
) {
    const auto u = std::lround(at.x()), v = std::lround(at.y());
    if (u < 0 || v < 0 || u >= lens.width || v >= lens.height) return std::nullopt;
    const std::uint16_t counts = depth[static_cast<std::size_t>(v * lens.width + u)];
    if (counts == 0) return std::nullopt;
    const double along = n.dot(lens.ray(static_cast<double>(u), static_cast<double>(v)));
    const double z = n.dot(p) / along;
    if (!(z > 0.05) || !(std::abs(along) > 1e-3)) return std::nullopt;
    const double predicted = scale.steps_at(z);
    const double sigma = scale.sigma_at(predicted);
    const double fault = kMeshFault_m / (scale.inverse_depth_step * z * z);
    const double off = scale.steps(counts) - predicted;
    return off / std::hypot(kNoiseSigmas * sigma, fault);
}

double share(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

ModelProof prove(
    std::span<const std::uint16_t> depth,
    const Pinhole& lens,
    const DisparityScale& scale,
    const ModelView& view,
    const Eigen::Isometry3d& T_cam_obj
) {
    constexpr double kHides = kHidesSigmas / kNoiseSigmas;
    std::size_t seen = 0, misfit = 0;
    for (const auto& point : view.surface) {
        const Eigen::Vector3d p = T_cam_obj * point.p_obj;
        const Eigen::Vector3d n = T_cam_obj.linear() * point.n_obj;
        const auto off = off_plane(depth, lens, scale, lens.project(p), p, n);
        if (!off || *off > kHides) continue;
        ++seen;
        if (std::abs(*off) > 1.0) ++misfit;
    }
    std::size_t asked = 0, goes_on = 0;
    for (const auto& point : view.outline) {
        const Eigen::Vector3d p = T_cam_obj * point.p_obj;
        const Eigen::Vector3d face = T_cam_obj * point.p_face_obj;
        const Eigen::Vector3d n = T_cam_obj.linear() * point.n_face_obj;
        if (-n.dot(face.normalized()) < kLeastSlant) continue;
        std::size_t on = 0, known = 0;
        for (const double beyond : kBeyond_px) {
            const auto off =
                off_plane(depth, lens, scale, lens.project(p) + beyond * point.outwards, face, n);
            if (off && *off > kHides) break;
            ++known;  // without a reading it does not go on
            if (off && std::abs(*off) <= 1.0) ++on;
        }
        if (known < kBeyond_px.size()) continue;
        ++asked;
        if (on == kBeyond_px.size()) ++goes_on;
    }
    return {share(misfit, seen), share(goes_on, asked)};
}

}  // namespace kinectlab
