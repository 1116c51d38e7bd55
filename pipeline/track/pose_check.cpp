#include "pipeline/track/pose_check.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace kinectlab {
namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

constexpr std::size_t kFirstLook = 16;  // points after which most poses are given up
constexpr float kFirstScore = 0.1F;
constexpr float kOutsideWeight = 0.5F;
constexpr float kLeastKnown = 0.8F;  // of a view's points
constexpr int kSteps = 4;
constexpr float kReach = 1.6F;       // times the gate: a reading that pulls
constexpr float kStiffness = 1e-3F;  // of what no reading holds, per point
constexpr int kFewest = 8;

}  // namespace

PoseCheck::PoseCheck(const RgbdCamera& camera, double radius_m)
    : fx_(static_cast<float>(camera.depth.fx)),
      fy_(static_cast<float>(camera.depth.fy)),
      cx_(static_cast<float>(camera.depth.cx)),
      cy_(static_cast<float>(camera.depth.cy)),
      width_(camera.depth.width),
      height_(camera.depth.height),
      unit_m_(static_cast<float>(camera.depth_unit_m)),
      gate_m_(std::clamp(0.15F * static_cast<float>(radius_m), 0.01F, 0.03F)) {}

void PoseCheck::set(std::span<const std::uint16_t> depth) {
    z_.resize(depth.size());
    std::transform(depth.begin(), depth.end(), z_.begin(), [this](std::uint16_t counts) {
        return static_cast<float>(counts) * unit_m_;
    });
}

/// 0 without a reading, negative where the picture ends.
float PoseCheck::reading_at(const Eigen::Vector3f& p_cam) const {
    if (p_cam.z() < 0.1F) return -1.0F;
    const float inverse = 1.0F / p_cam.z();
    const float u = fx_ * p_cam.x() * inverse + cx_ + 0.5F;
    const float v = fy_ * p_cam.y() * inverse + cy_ + 0.5F;
    if (!(u >= 0.0F && v >= 0.0F)) return -1.0F;
    const auto column = static_cast<int>(u), row = static_cast<int>(v);
    if (column >= width_ || row >= height_) return -1.0F;
    return z_[static_cast<std::size_t>(row * width_ + column)];
}

float PoseCheck::score(const Eigen::Isometry3f& T_cam_obj, const SketchView& view) const {
    if (view.surface.empty()) return 0.0F;
    int sum = 0;
    std::size_t seen = 0;
    for (const auto& point : view.surface) {
        const Eigen::Vector3f p = T_cam_obj * point.p_obj;
        if (p.dot(T_cam_obj.linear() * point.n_obj) > 0.0F) continue;  // turned away in this pose
        const float z = reading_at(p);
        if (z == 0.0F) continue;
        if (++seen == kFirstLook && static_cast<float>(sum) < kFirstScore * kFirstLook)
            return static_cast<float>(sum) / kFirstLook;
        if (z < 0.0F) continue;
        const float off = z - p.z();
        if (std::abs(off) < gate_m_) ++sum;
        if (off > 2.0F * gate_m_) --sum;
    }
    // Of a pose that shows little of the view little is known.
    const auto known =
        std::max(static_cast<float>(seen), kLeastKnown * static_cast<float>(view.surface.size()));
    const float on = static_cast<float>(sum) / known;
    if (view.outside.empty()) return on;
    int goes_on = 0;
    for (const auto& point : view.outside) {
        const Eigen::Vector3f p = T_cam_obj * point;
        goes_on += std::abs(reading_at(p) - p.z()) < gate_m_ ? 1 : 0;
    }
    return on -
           kOutsideWeight * static_cast<float>(goes_on) / static_cast<float>(view.outside.size());
}

Eigen::Isometry3f PoseCheck::settle(Eigen::Isometry3f T_cam_obj, const SketchView& view) const {
    float reach = kReach * gate_m_;
    for (int step = 0; step < kSteps; ++step) {
        Matrix6f information = Matrix6f::Zero();
        Vector6f gradient = Vector6f::Zero();
        int used = 0;
        const Eigen::Vector3f centre = T_cam_obj.translation();
        for (const auto& point : view.surface) {
            const Eigen::Vector3f p = T_cam_obj * point.p_obj;
            const float z = reading_at(p);
            if (z <= 0.0F || std::abs(z - p.z()) > reach) continue;
            const Eigen::Vector3f n = T_cam_obj.linear() * point.n_obj;
            const Eigen::Vector3f read = p * (z / p.z());
            Vector6f j;
            j.head<3>() = n;
            j.tail<3>() = (p - centre).cross(n);
            information.selfadjointView<Eigen::Lower>().rankUpdate(j);
            gradient += n.dot(read - p) * j;
            ++used;
        }
        if (used < kFewest) break;
        // Turns are of the size of shifts once multiplied by the object's own size.
        const float stiffness = kStiffness * static_cast<float>(used);
        information.diagonal().head<3>().array() += stiffness;
        information.diagonal().tail<3>().array() += stiffness * gate_m_ * gate_m_ * 40.0F;
        const Vector6f change = information.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
        if (!change.allFinite()) break;
        const float angle = change.tail<3>().norm();
        if (angle > 1e-6F) {
            const Eigen::Vector3f axis = change.tail<3>() / angle;
            T_cam_obj.linear() = Eigen::AngleAxisf(std::min(angle, 0.3F), axis).toRotationMatrix() *
                                 T_cam_obj.linear();
        }
        T_cam_obj.translation() += change.head<3>();
        reach = std::max(0.75F * reach, gate_m_);
    }
    return T_cam_obj;
}

}  // namespace kinectlab
