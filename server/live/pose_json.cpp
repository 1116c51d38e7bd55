#include "server/live/pose_json.hpp"

#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinectlab::live {
namespace {

const char* status_text(TrackStatus status) {
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

void append(std::string& out, const char* name, const Eigen::Vector3d& value) {
    fmt::format_to(std::back_inserter(out), ",\"{}\":", name);
    if (!value.allFinite()) {
        out += "null";
        return;
    }
    // 10 µm and 10 µm/s: well below what a Kinect resolves.
    fmt::format_to(
        std::back_inserter(out), "[{:.5f},{:.5f},{:.5f}]", value.x(), value.y(), value.z()
    );
}

}  // namespace

std::string encode_pose(const bus::PoseMeasured& pose, std::uint64_t seq) {
    const MotionSample& sample = pose.sample;
    std::string out;
    out.reserve(256);
    fmt::format_to(
        std::back_inserter(out),
        R"({{"type":"pose","seq":{},"t_ns":{},"object":{},"status":"{}")",
        seq,
        sample.t,
        nlohmann::json(pose.object).dump(),
        status_text(sample.status)
    );
    append(out, "p", sample.p_lab);
    append(out, "v", sample.v_lab);
    append(out, "s", sample.sigma_p());
    if (sample.has_orientation && sample.q_lab_obj.coeffs().allFinite()) {
        const Eigen::Quaterniond& q = sample.q_lab_obj;
        fmt::format_to(
            std::back_inserter(out),
            ",\"q\":[{:.5f},{:.5f},{:.5f},{:.5f}]",
            q.x(),
            q.y(),
            q.z(),
            q.w()
        );
    }
    return out;
}

std::string missed_tail(std::uint64_t missed) {
    return fmt::format(",\"missed\":{}}}", missed);
}

std::string encode_trail_point(const std::string& object, const MotionSample& sample) {
    const auto& p = sample.p_lab;
    return fmt::format(
        "[{},{:.4f},{:.4f},{:.4f},{}]", sample.t, p.x(), p.y(), p.z(), nlohmann::json(object).dump()
    );
}

}  // namespace kinectlab::live
