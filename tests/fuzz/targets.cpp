#include "tests/fuzz/targets.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "pipeline/sensor/camera_json.hpp"
#include "pipeline/sensor/mesh_file.hpp"
#include "pipeline/sensor/pcd_file.hpp"
#include "pipeline/sensor/png_image.hpp"
#include "pipeline/sensor/recording.hpp"
#include "server/experiments/objects_json.hpp"
#include "server/experiments/strict_json.hpp"
#include "tests/fuzz/png_targets.hpp"

namespace kinectlab::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "input";

Bytes bytes_of(std::string_view text) {
    return {text.begin(), text.end()};
}

template <class Number>
void append(Bytes& bytes, Number number) {
    const auto* raw = reinterpret_cast<const std::uint8_t*>(&number);
    bytes.insert(bytes.end(), raw, raw + sizeof number);
}

/// A folder of this process, gone with it.
class Scratch {
public:
    Scratch() : path(fs::temp_directory_path() / ("kinectlab-fuzz-" + std::to_string(::getpid()))) {
        fs::create_directories(path / "depth");
    }
    ~Scratch() {
        std::error_code code;
        fs::remove_all(path, code);
    }
    void put(const fs::path& name, const Bytes& bytes) const {
        std::ofstream file(path / name, std::ios::binary);
        file.write(
            reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())
        );
    }
    const fs::path path;
};

const Scratch& scratch() {
    static const Scratch folder;
    return folder;
}

Bytes depth_png() {
    std::vector<std::uint16_t> depth(24 * 16);
    for (std::size_t i = 0; i < depth.size(); ++i)
        depth[i] = static_cast<std::uint16_t>(5000 + 7 * i);
    return encode_png(std::span<const std::uint16_t>(depth), {24, 16});
}

Bytes camera_json() {
    return bytes_of(
        R"({"fx": 20, "fy": 20, "cx": 11.5, "cy": 7.5, "depth_scale": 5000, "frame_rate_hz": 30,)"
        R"("T_lab_cam": [[1,0,0,0],[0,0,1,0],[0,-1,0,0.9],[0,0,0,1]], "clock_u": 1e-5,)"
        R"("color": {"fx": 20, "fy": 20, "cx": 11.5, "cy": 7.5, "width": 24, "height": 16, "R_color_depth": [[1,0,0],[0,1,0],[0,0,1]],)"
        R"("t_color_depth_m": [0.025, 0, 0]}})"
    );
}

std::vector<Bytes> pcd_files() {
    const std::string header =
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
        "WIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA ";
    Bytes binary = bytes_of(header + "binary\n");
    for (int i = 0; i < 12; ++i)
        append(binary, 0.25F * static_cast<float>(i));
    Bytes compressed = bytes_of(header + "binary_compressed\n");
    append(compressed, std::uint32_t{5});
    append(compressed, std::uint32_t{48});
    // LZF: one zero as it is, then 47 copies of it.
    for (const std::uint8_t byte : {0x00, 0x00, 0xe0, 0x26, 0x00})
        compressed.push_back(byte);
    return {bytes_of(header + "ascii\n0 0 1\n0.1 0 1\n0 0.1 1\nnan nan nan\n"), binary, compressed};
}

std::vector<Bytes> ply_files() {
    const auto header = [](const std::string& format) {
        return "ply\nformat " + format +
               " 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\n"
               "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
               "end_header\n";
    };
    Bytes binary = bytes_of(header("binary_little_endian"));
    for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F})
        append(binary, x);
    for (int face = 0; face < 2; ++face) {
        binary.push_back(3);
        for (const std::int32_t corner : {0, 1, 2 + face})
            append(binary, corner);
    }
    return {bytes_of(header("ascii") + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 2 3\n"), binary};
}

std::vector<Bytes> stl_files() {
    Bytes binary(80, 's');
    append(binary, std::uint32_t{1});
    for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F})
        append(binary, x);
    append(binary, std::uint16_t{0});
    return {
        bytes_of("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                 "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n"),
        binary};
}

constexpr std::string_view kObjects = R"({"preprocess": {"depth_cut": {"method": "wall"}},
"objects": [{"name": "bob", "method": "sphere", "radius_m": 0.05},
{"name": "box", "method": "texture", "box": [282, 100, 90, 140], "learn_at_s": 8, "spots": "binary"},
{"name": "red", "method": "colour", "hue_deg": [340, 20]}, {"name": "moved", "method": "change"},
{"name": "can", "method": "cylinder", "in": "scene"}, {"name": "board", "method": "plane"}]})";

bool read_png(const Bytes& bytes) {
    const auto size = read_png_size(bytes, PngKind::depth16, kName);
    if (!size || size->width * size->height > 1 << 20) return false;
    std::vector<std::uint16_t> depth(
        static_cast<std::size_t>(size->width) * static_cast<std::size_t>(size->height)
    );
    return decode_png(bytes, std::span<std::uint16_t>(depth), kName).has_value();
}

bool read_camera(const Bytes& bytes) {
    scratch().put("camera.json", bytes);
    return read_camera_json(scratch().path / "camera.json").has_value();
}

/// The bytes are the list of a folder whose picture and camera are sound.
bool read_sequence(const Bytes& bytes) {
    scratch().put("depth.txt", bytes);
    scratch().put("depth/1.png", depth_png());
    scratch().put("depth/2.png", depth_png());
    scratch().put("camera.json", camera_json());
    auto source = open_recording(scratch().path, {.with_colour = false});
    if (!source) return false;
    RgbdFrame frame;
    for (int i = 0; i < 4; ++i)
        if (!(*source)->next(frame, std::chrono::milliseconds(0))) return false;
    return true;
}

bool read_objects(const Bytes& bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return experiments::parse_json(text, kName)
        .and_then(experiments::read_tracking_plan)
        .has_value();
}

}  // namespace

std::vector<Target> all_targets() {
    return {
        {"pcd",
         pcd_files(),
         [](const Bytes& b) {
             return parse_pcd(b, kName).has_value();
         }},
        {"pcd_points",
         pcd_files(),
         [](const Bytes& b) {
             return parse_pcd_points(b, kName).has_value();
         }},
        {"ply",
         ply_files(),
         [](const Bytes& b) {
             return parse_ply(b, kName).has_value();
         }},
        {"obj",
         {bytes_of("# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 "
                   "-1\n")},
         [](const Bytes& b) {
             return parse_obj(b, kName).has_value();
         }},
        {"stl",
         stl_files(),
         [](const Bytes& b) {
             return parse_stl(b, kName).has_value();
         }},
        {"png", {depth_png()}, read_png},
        {"png_rows", {png_rows()}, read_png_rows},
        {"png_data", {png_data()}, read_png_data},
        {"sequence",
         {bytes_of("# timestamp filename\n0.000000 depth/1.png\n0.033333 depth/2.png\n")},
         read_sequence},
        {"camera_json", {camera_json()}, read_camera},
        {"objects_json", {bytes_of(kObjects)}, read_objects},
    };
}

}  // namespace kinectlab::fuzz
