#include "pipeline/sensor/camera_json.hpp"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "pipeline/core/nearest_name.hpp"
#include "pipeline/sensor/file_bytes.hpp"

namespace kinectlab {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxBytes = 64 * 1024;
constexpr double kMaxSide = 4096;

// Lists and objects are not shown: they may be nested deeper than the stack.
std::string show(const json& value) {
    return value.is_structured() ? std::string("of type ") + value.type_name()
                                 : value.dump().substr(0, 60);
}

// Reads one object's members; the first error is kept and ends all further reading.
class Members {
public:
    Members(const json& object, std::string path, const std::vector<std::string>& keys)
        : object_(object), path_(std::move(path)) {
        if (!object.is_object()) refuse("", "is no JSON object", "give {\"fx\": …}");
        for (const auto& [key, value] : object.items()) {
            if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
            refuse(key, "is not known", did_you_mean(key, keys));
        }
    }

    [[nodiscard]] bool has(const std::string& key) const {
        return object_.is_object() && object_.contains(key);
    }

    double number(const std::string& key, double low, double high) {
        if (error_) return 0.0;
        const std::string range =
            "give a number from " + json(low).dump() + " to " + json(high).dump();
        if (!has(key)) return refuse(key, "is missing", range), 0.0;
        const json& value = object_.at(key);
        const double number = value.is_number() ? value.get<double>() : std::nan("");
        if (number >= low && number <= high) return number;
        refuse(key, "is " + show(value), range);
        return 0.0;
    }
    double number_or(const std::string& key, double low, double high, double otherwise) {
        return has(key) ? number(key, low, high) : otherwise;
    }

    /// A rows x columns matrix as a list of rows, or a column vector as a plain list.
    template <int Rows, int Columns>
    Eigen::Matrix<double, Rows, Columns> matrix(const std::string& key) {
        Eigen::Matrix<double, Rows, Columns> m = Eigen::Matrix<double, Rows, Columns>::Zero();
        if (error_) return m;
        const std::string cure =
            "give " + std::to_string(Rows) + " rows of " + std::to_string(Columns) + " numbers";
        if (!has(key)) return refuse(key, "is missing", cure), m;
        const json& rows = object_.at(key);
        const auto fits = [](const json& list, std::size_t n) {
            return list.is_array() && list.size() == n;
        };
        if (!fits(rows, Rows)) return refuse(key, "has not the right shape", cure), m;
        for (int r = 0; r < Rows; ++r) {
            const json row = Columns == 1 ? json::array({rows[r]}) : rows[r];
            if (!fits(row, Columns)) return refuse(key, "has not the right shape", cure), m;
            for (int c = 0; c < Columns; ++c) {
                const double value = row[c].is_number() ? row[c].get<double>() : std::nan("");
                if (!std::isfinite(value) || std::abs(value) > 1e6) {
                    return refuse(key, "holds " + show(row[c]), cure), m;
                }
                m(r, c) = value;
            }
        }
        return m;
    }

    Eigen::Matrix3d rotation(const std::string& key, const Eigen::Matrix3d& R) {
        const double off = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
        if (!error_ && (off > 1e-3 || R.determinant() < 0)) {
            refuse(
                key, "does not rotate", "give rows of length 1, at right angles, determinant +1"
            );
        }
        return Eigen::Quaterniond(R).normalized().toRotationMatrix();
    }

    void refuse(const std::string& key, std::string message, std::string cure) {
        if (error_) return;
        const std::string place = path_.empty() || key.empty() ? path_ + key : path_ + "." + key;
        error_ = Error{ErrorCode::bad_data, place, std::move(message), std::move(cure)};
    }
    [[nodiscard]] const json& at(const std::string& key) const { return object_.at(key); }
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    const json& object_;
    std::string path_;
    std::optional<Error> error_;
};

Pinhole read_pinhole(Members& members, bool& has_size) {
    Pinhole pinhole;
    pinhole.fx = members.number("fx", 1.0, 1e5);
    pinhole.fy = members.number("fy", 1.0, 1e5);
    pinhole.cx = members.number("cx", -kMaxSide, 2 * kMaxSide);
    pinhole.cy = members.number("cy", -kMaxSide, 2 * kMaxSide);
    has_size = members.has("width") || members.has("height");
    if (has_size) {
        pinhole.width = static_cast<int>(members.number("width", 16, kMaxSide));
        pinhole.height = static_cast<int>(members.number("height", 16, kMaxSide));
    }
    return pinhole;
}

std::optional<Error> read_colour(const json& object, const std::string& path, CameraFile& file) {
    const std::string word = path;  // "color" or "colour": its matrices are spelled likewise
    const std::string R_key = "R_" + word + "_depth";
    const std::string t_key = "t_" + word + "_depth_m";
    Members members(object, path, {"fx", "fy", "cx", "cy", "width", "height", R_key, t_key});
    file.camera.colour = read_pinhole(members, file.has_colour_size);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = members.rotation(R_key, members.matrix<3, 3>(R_key));
    T.translation() = members.matrix<3, 1>(t_key);
    file.camera.T_colour_depth = T;
    file.has_colour = true;
    return members.error();
}

std::optional<Error> read_noise(const json& object, DisparityNoise& noise) {
    Members members(object, "noise", {"inverse_depth_step", "sigma_steps"});
    noise.inverse_depth_step = members.number("inverse_depth_step", 1e-7, 1.0);
    noise.sigma_steps = members.number("sigma_steps", 1e-3, 100.0);
    return members.error();
}

std::optional<Eigen::Isometry3d> read_pose(Members& members) {
    const Eigen::Matrix4d m = members.matrix<4, 4>("T_lab_cam");
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = members.rotation("T_lab_cam", m.topLeftCorner<3, 3>());
    T.translation() = m.topRightCorner<3, 1>();
    if ((m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-9) {
        members.refuse("T_lab_cam", "has another last row than 0 0 0 1", "give a rigid transform");
    }
    return T;
}

Result<CameraFile> read_document(const json& document, DepthUnit unit) {
    Members members(
        document,
        "",
        {"fx",
         "fy",
         "cx",
         "cy",
         "depth_scale",
         "width",
         "height",
         "color",
         "colour",
         "T_lab_cam",
         "depth_scale_u",
         "clock_u",
         "noise",
         "frame_rate_hz"}
    );
    CameraFile file;
    auto& camera = file.camera;
    camera.depth = read_pinhole(members, file.has_size);
    camera.colour = camera.depth;
    if (unit == DepthUnit::in_counts || members.has("depth_scale"))
        camera.depth_unit_m = 1.0 / members.number("depth_scale", 1.0, 1e6);
    camera.depth_scale_u = members.number_or("depth_scale_u", 0.0, 0.5, camera.depth_scale_u);
    camera.clock_u = members.number_or("clock_u", 0.0, 0.1, camera.clock_u);
    if (members.has("T_lab_cam")) file.T_lab_cam = read_pose(members);
    if (members.has("frame_rate_hz"))
        file.frame_rate_hz = members.number("frame_rate_hz", 0.01, 1000);
    if (members.error()) return tl::unexpected<Error>(*members.error());

    for (const char* word : {"color", "colour"}) {
        if (!members.has(word)) continue;
        if (const auto error = read_colour(members.at(word), word, file))
            return tl::unexpected<Error>(*error);
    }
    if (members.has("noise")) {
        if (const auto error = read_noise(members.at("noise"), camera.noise))
            return tl::unexpected<Error>(*error);
    }
    return file;
}

json pinhole_to_json(const Pinhole& pinhole) {
    return {
        {"fx", pinhole.fx},
        {"fy", pinhole.fy},
        {"cx", pinhole.cx},
        {"cy", pinhole.cy},
        {"width", pinhole.width},
        {"height", pinhole.height}};
}

template <class Matrix>
json rows_of(const Matrix& m) {
    json rows = json::array();
    for (int r = 0; r < m.rows(); ++r) {
        json row = json::array();
        for (int c = 0; c < m.cols(); ++c)
            row.push_back(m(r, c));
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace

CameraFile default_camera() {
    CameraFile file;
    file.camera.depth_unit_m = 1.0 / 5000.0;
    file.has_size = true;
    return file;
}

Result<CameraFile> read_camera_json(const std::filesystem::path& path, DepthUnit unit) {
    std::vector<std::uint8_t> bytes;
    if (auto read = read_file(path, kMaxBytes, bytes); !read)
        return tl::unexpected<Error>(read.error());
    const json document = json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (document.is_discarded()) {
        return fail(
            ErrorCode::bad_data,
            path.string(),
            "is not valid JSON",
            R"(give {"fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5, "depth_scale": 5000})"
        );
    }
    return read_document(document, unit).map_error([&](Error error) {
        error.field = path.string() + (error.field.empty() ? "" : ": " + error.field);
        return error;
    });
}

void write_camera_json(const std::filesystem::path& path, const CameraFile& file) {
    const auto& camera = file.camera;
    json document = pinhole_to_json(camera.depth);
    document["depth_scale"] = 1.0 / camera.depth_unit_m;
    document["depth_scale_u"] = camera.depth_scale_u;
    document["clock_u"] = camera.clock_u;
    document["noise"] = {
        {"inverse_depth_step", camera.noise.inverse_depth_step},
        {"sigma_steps", camera.noise.sigma_steps}};
    if (file.has_colour) {
        document["color"] = pinhole_to_json(camera.colour);
        document["color"]["R_color_depth"] = rows_of(camera.T_colour_depth.linear());
        const Eigen::Vector3d t = camera.T_colour_depth.translation();
        document["color"]["t_color_depth_m"] = {t.x(), t.y(), t.z()};
    }
    if (file.T_lab_cam) document["T_lab_cam"] = rows_of(file.T_lab_cam->matrix());
    if (file.frame_rate_hz) document["frame_rate_hz"] = *file.frame_rate_hz;
    std::ofstream stream(path);
    stream << document.dump(1) << '\n';
    stream.close();
    if (!stream) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace kinectlab
