#include "server/experiments/poses_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace kinectlab::experiments {
namespace {

void append_number(std::string& csv, double value) {
    csv += ',';
    if (!std::isfinite(value)) return;
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    csv.append(text.data(), end);
}

/// Zero stands for what was not measured, or is not kept.
void append_measured(std::string& csv, double value) {
    append_number(csv, value > 0.0 ? value : std::numeric_limits<double>::quiet_NaN());
}

void append_vector(std::string& csv, const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i)
        append_number(csv, v[i]);
}

}  // namespace

const char* to_text(TrackStatus status) {
    switch (status) {
        case TrackStatus::tracked:
            return "tracked";
        case TrackStatus::interpolated:
            return "interpolated";
        case TrackStatus::lost:
            break;
    }
    return "lost";
}

const std::string& poses_csv_header() {
    static const std::string kHeader =
        "t_ns,object,status,x,y,z,qx,qy,qz,qw,sx,sy,sz,vx,vy,vz,wx,wy,wz,"
        "srx,sry,srz,radius,s_radius,half_angle,s_half_angle,points,inlier_share,rms_steps\n";
    return kHeader;
}

void append_pose_row(std::string& csv, const std::string& object, const MotionSample& sample) {
    static const Eigen::Vector3d kNothing =
        Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    const bool seen = sample.status != TrackStatus::lost;
    const bool turned = seen && sample.has_orientation;
    csv += std::to_string(sample.t) + ',' + object + ',' + to_text(sample.status);
    append_vector(csv, seen ? sample.p_lab : kNothing);
    append_vector(csv, turned ? Eigen::Vector3d(sample.q_lab_obj.vec()) : kNothing);
    append_number(csv, turned ? sample.q_lab_obj.w() : kNothing.x());
    append_vector(csv, seen ? sample.sigma_p() : kNothing);
    append_vector(csv, seen ? sample.v_lab : kNothing);
    append_vector(csv, turned ? sample.w_lab : kNothing);
    for (int i = 3; i < 6; ++i)
        append_measured(csv, turned ? std::sqrt(sample.covariance(i, i)) : 0.0);
    const bool tracked = sample.status == TrackStatus::tracked;
    const ShapeSize size = tracked ? sample.size : ShapeSize{};
    append_number(csv, size.radius_m);
    append_number(csv, size.radius_u);
    append_number(csv, size.half_angle_rad);
    append_number(csv, size.half_angle_u);
    const TrackQuality quality = tracked ? sample.quality : TrackQuality{};
    append_measured(csv, quality.points);
    append_measured(csv, quality.inlier_share);
    append_measured(csv, quality.rms_steps);
    csv += '\n';
}

}  // namespace kinectlab::experiments
