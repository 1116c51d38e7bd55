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
        "t_ns,object,status,x,y,z,qx,qy,qz,qw,sx,sy,sz,vx,vy,vz,wx,wy,wz\n";
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
    csv += '\n';
}

}  // namespace kinectlab::experiments
