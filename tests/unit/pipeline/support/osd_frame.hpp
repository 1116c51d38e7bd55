#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/sensor/lzf.hpp"
#include "pipeline/sensor/pcd_file.hpp"
#include "pipeline/sensor/pcd_sequence.hpp"
#include "pipeline/track/shapes.hpp"

namespace kinectlab::test {

inline constexpr std::uint32_t kTableLabel = 1;  // 0 is nothing, others are objects

/// A frame of the Object Segmentation Database with the label of each pixel.
struct OsdFrame {
    RgbdCamera camera;
    RgbdFrame frame;
    std::vector<std::uint32_t> labels;
};

/// The label field stands first in these files, and compressed files keep each field together.
inline std::vector<std::uint32_t> osd_labels(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const auto header = parse_pcd_header({bytes, text.size()}, path.string());
    if (!header || header->fields.front().name != "label") return {};
    std::array<std::uint32_t, 2> sizes{};
    std::memcpy(sizes.data(), bytes + header->data_offset, sizeof sizes);
    std::vector<std::uint8_t> all(sizes[1]);
    if (!decompress_lzf({bytes + header->data_offset + sizeof sizes, sizes[0]}, all)) return {};
    std::vector<std::uint32_t> labels(static_cast<std::size_t>(header->width * header->height));
    std::memcpy(labels.data(), all.data(), labels.size() * sizeof labels[0]);
    return labels;
}

/// Nothing where the file is missing or cannot be read.
inline std::optional<OsdFrame> osd_frame(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) return std::nullopt;
    auto source = open_pcd_sequence(path);
    if (!source) return std::nullopt;
    OsdFrame osd;
    osd.camera = (*source)->info().camera;
    if (!(*source)->next(osd.frame, std::chrono::milliseconds(0))) return std::nullopt;
    osd.labels = osd_labels(path);
    return osd;
}

/// How the shapes found agree with the labels, in pixels. A shape is taken for the thing that most
/// of its pixels belong to.
struct OsdAgreement {
    std::vector<std::uint32_t> label_of;  ///< of each shape
    double given = 0.0, right = 0.0;      ///< of all shapes
    double of_table = 0.0, of_objects = 0.0;
    double table = 0.0, objects = 0.0;  ///< that have a reading

    [[nodiscard]] double precision() const { return right / given; }
    [[nodiscard]] double recall_of_table() const { return of_table / table; }
    [[nodiscard]] double recall_of_objects() const { return of_objects / objects; }
};

inline OsdAgreement agreement(const OsdFrame& osd, std::span<const SceneShape> shapes) {
    OsdAgreement result;
    for (const auto& shape : shapes) {
        std::map<std::uint32_t, int> votes;
        for (const auto pixel : shape.pixels)
            ++votes[osd.labels[pixel]];
        const auto most =
            std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                return a.second < b.second;
            });
        const auto [label, own] = *most;
        result.label_of.push_back(label);
        result.given += static_cast<double>(shape.pixels.size());
        result.right += own;
        if (label == kTableLabel) result.of_table += own;
        if (label > kTableLabel) result.of_objects += own;
    }
    for (std::size_t i = 0; i < osd.labels.size(); ++i)
        if (osd.labels[i] > 0 && osd.frame.depth[i] != 0)
            (osd.labels[i] == kTableLabel ? result.table : result.objects) += 1.0;
    return result;
}

}  // namespace kinectlab::test
