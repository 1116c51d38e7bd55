#include "pipeline/sensor/pcd_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/core/file_ending.hpp"
#include "pipeline/core/number_text.hpp"
#include "pipeline/sensor/camera_json.hpp"
#include "pipeline/sensor/file_bytes.hpp"
#include "pipeline/sensor/pcd_file.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPcdBytes = 512U << 20U;
constexpr double kUnit = 0.0002;        // m for each count
constexpr double kRayTolerance = 0.02;  // relative to depth: 10 px at f = 525
constexpr std::size_t kMaxFiles = 100'000;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// "frame_9.pcd" comes before "frame_10.pcd".
bool natural_less(const std::string& a, const std::string& b) {
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() && j < b.size()) {
        if (is_digit(a[i]) && is_digit(b[j])) {
            const auto number_at = [](const std::string& s, std::size_t& at) {
                while (at < s.size() && s[at] == '0')
                    ++at;
                const std::size_t start = at;
                while (at < s.size() && is_digit(s[at]))
                    ++at;
                return s.substr(start, at - start);
            };
            const std::string x = number_at(a, i);
            const std::string y = number_at(b, j);
            if (x.size() != y.size()) return x.size() < y.size();
            if (x != y) return x < y;
        } else {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i;
            ++j;
        }
    }
    return a.size() - i < b.size() - j;
}

std::vector<fs::path> files_of(const fs::path& path) {
    std::error_code code;
    if (!fs::is_directory(path, code)) return {path};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(path, code)) {
        if (file_ending(entry.path()) == ".pcd" && files.size() < kMaxFiles)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return natural_less(a.filename().string(), b.filename().string());
    });
    return files;
}

std::uint16_t to_counts(float z) {
    const double counts = std::round(static_cast<double>(z) / kUnit);
    return counts >= 1.0 && counts <= 65535.0 ? static_cast<std::uint16_t>(counts)
                                              : std::uint16_t{0};  // NaN: 0
}

// PCL's viewers have y up and z backwards: a frame that lies behind the camera as a whole was taken
// so, and is turned by half a turn about x.
void face_forward(PcdCloud& cloud) {
    const auto is_before = [](float z) {
        return z > 0.0F;
    };
    const auto is_behind = [](float z) {
        return z < 0.0F;
    };
    if (std::any_of(cloud.z.begin(), cloud.z.end(), is_before) ||
        std::none_of(cloud.z.begin(), cloud.z.end(), is_behind))
        return;
    for (auto* axis : {&cloud.y, &cloud.z})
        for (float& value : *axis)
            value = -value;
}

// Share of the points in front of the camera that do not lie on the rays of their pixels.
double share_off_rays(const PcdCloud& cloud, const Pinhole& camera) {
    std::size_t seen = 0;
    std::size_t off = 0;
    for (int v = 0; v < cloud.height; v += 4) {
        for (int u = 0; u < cloud.width; u += 4) {
            const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud.width) +
                           static_cast<std::size_t>(u);
            const double z = cloud.z[i];
            if (!(z > 0.0)) continue;
            const Eigen::Vector3d ray = camera.ray(u, v);
            const double dx = std::abs(cloud.x[i] / z - ray.x());
            const double dy = std::abs(cloud.y[i] / z - ray.y());
            ++seen;
            if (!(dx < kRayTolerance && dy < kRayTolerance)) ++off;
        }
    }
    return seen == 0 ? 0.0 : static_cast<double>(off) / static_cast<double>(seen);
}

/// Not a frame without readings, but one whose points all lie where no count reaches: in another
/// unit, mostly. Gives the distance of the nearest one.
std::optional<float> nearest_out_of_reach(
    const PcdCloud& cloud, const std::vector<std::uint16_t>& depth
) {
    const auto is_reading = [](std::uint16_t counts) {
        return counts != 0;
    };
    if (std::any_of(depth.begin(), depth.end(), is_reading)) return std::nullopt;
    std::optional<float> nearest;
    for (const float z : cloud.z)
        if (std::isfinite(z) && z != 0.0F && (!nearest || std::abs(z) < std::abs(*nearest)))
            nearest = z;
    return nearest;
}

class PcdSequence : public FrameSource {
public:
    PcdSequence(SourceInfo info, std::vector<fs::path> files, std::string size_from)
        : info_(std::move(info)), files_(std::move(files)), size_from_(std::move(size_from)) {}

    [[nodiscard]] const SourceInfo& info() const override { return info_; }

    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds) override {
        if (position_ == files_.size()) return FrameStatus::end;
        const std::string name = files_[position_].string();
        if (auto read = read_file(files_[position_], kMaxPcdBytes, bytes_); !read)
            return tl::unexpected<Error>(read.error());
        auto cloud = parse_pcd(bytes_, name);
        if (!cloud) return tl::unexpected<Error>(cloud.error());
        face_forward(*cloud);
        if (auto fits = check(*cloud, name); !fits) return tl::unexpected<Error>(fits.error());
        frame.depth.resize(cloud->z.size());
        std::transform(cloud->z.begin(), cloud->z.end(), frame.depth.begin(), to_counts);
        if (const auto z = nearest_out_of_reach(*cloud, frame.depth))
            return fail(
                ErrorCode::bad_data,
                name,
                "has no point between 0.0002 and 13.1 m before the camera; the nearest is at z = " +
                    number_text(*z),
                "give metres (millimetres: divide by 1000), x right, y down, z forward"
            );
        frame.rgb = std::move(cloud->rgb);
        frame.index = position_++;
        frame.t = static_cast<TimeNs>(frame.index) * kNsPerSecond / 30;
        frame.t_colour = frame.rgb.empty() ? 0 : frame.t;
        return FrameStatus::frame;
    }

private:
    [[nodiscard]] Result<void> check(const PcdCloud& cloud, const std::string& name) const {
        const Pinhole& camera = info_.camera.depth;
        if (cloud.width != camera.width || cloud.height != camera.height) {
            return fail(
                ErrorCode::bad_data,
                name,
                "is " + std::to_string(cloud.width) + "x" + std::to_string(cloud.height) +
                    ", but " + size_from_ + " " + std::to_string(camera.width) + "x" +
                    std::to_string(camera.height),
                "give clouds of one camera, all of one size, and its width and height in "
                "camera.json"
            );
        }
        if (share_off_rays(cloud, camera) > 0.5) {
            return fail(
                ErrorCode::bad_data,
                name,
                "has points that do not lie on the camera's rays (fx " + number_text(camera.fx) +
                    ")",
                "give x right, y down, z forward, and camera.json beside the file if it is another "
                "camera"
            );
        }
        return {};
    }

    SourceInfo info_;
    std::vector<fs::path> files_;
    std::string size_from_;
    std::size_t position_ = 0;
    std::vector<std::uint8_t> bytes_;
};

// The camera's size is the first cloud's where camera.json gives none.
Result<CameraFile> camera_of(const fs::path& folder, const fs::path& first) {
    const auto header = [&]() -> Result<PcdHeader> {
        std::vector<std::uint8_t> bytes;
        if (auto read = read_file(first, kMaxPcdBytes, bytes); !read)
            return tl::unexpected<Error>(read.error());
        return parse_pcd_header(bytes, first.string());
    }();
    if (!header) return tl::unexpected<Error>(header.error());
    std::error_code code;
    const fs::path json = folder / "camera.json";
    auto file = fs::exists(json, code) ? read_camera_json(json, DepthUnit::known)
                                       : Result<CameraFile>(default_camera());
    if (file && !file->has_size) {
        file->camera.depth.width = header->width;
        file->camera.depth.height = header->height;
    }
    return file;
}

/// What says how large clouds must be.
std::string size_from(const CameraFile& file, const fs::path& first) {
    std::error_code code;
    if (!fs::exists(first.parent_path() / "camera.json", code))
        return "without camera.json the camera has";
    return file.has_size ? "camera.json says" : "the first, " + first.filename().string() + ", is";
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_pcd_sequence(const fs::path& path) {
    auto files = files_of(path);
    if (files.empty()) {
        return fail(
            ErrorCode::not_found,
            path.string(),
            "holds no .pcd files",
            "give a folder of organised .pcd files"
        );
    }
    auto file = camera_of(files.front().parent_path(), files.front());
    if (!file) return tl::unexpected<Error>(file.error());
    SourceInfo info;
    info.name = fs::absolute(path).lexically_normal().filename().string();
    info.camera = file->camera;
    info.camera.depth_unit_m = kUnit;
    info.camera.colour =
        info.camera.depth;  // the colour of a cloud's point stands at its own pixel
    info.camera.T_colour_depth = Eigen::Isometry3d::Identity();
    info.T_lab_cam = file->T_lab_cam;
    info.frame_count = files.size();
    const fs::path first = files.front();
    return std::make_unique<PcdSequence>(
        std::move(info), std::move(files), size_from(*file, first)
    );
}

}  // namespace kinectlab
