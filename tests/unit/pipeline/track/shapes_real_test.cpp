#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>

#include <gtest/gtest.h>

#include "pipeline/sensor/lzf.hpp"
#include "pipeline/sensor/pcd_file.hpp"
#include "pipeline/sensor/pcd_sequence.hpp"
#include "pipeline/track/shapes.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kTable = 1;  // its label; 0 is nothing, others are objects

fs::path folder() {
    const char* data = std::getenv("KINECTLAB_SHARED_DATA");
    return (data != nullptr ? fs::path(data)
                            : fs::path(KINECTLAB_SOURCE_DIR).parent_path() / "shared" / "data") /
           "pcl";
}

/// The label field stands first in these files, and compressed files keep each field together.
std::vector<std::uint32_t> labels_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const auto header = parse_pcd_header({bytes, text.size()}, path.string());
    if (!header || header->fields.front().name != "label") return {};
    std::array<std::uint32_t, 2> sizes{};
    std::memcpy(sizes.data(), bytes + header->data_offset, sizeof sizes);
    std::vector<std::uint8_t> all(sizes[1]);
    if (!decompress_lzf({bytes + header->data_offset + sizeof sizes, sizes[0]}, all)) return {};
    const auto points = static_cast<std::size_t>(header->width * header->height);
    std::vector<std::uint32_t> labels(points);
    std::memcpy(labels.data(), all.data(), points * sizeof labels[0]);
    return labels;
}

struct Labelled {
    const SceneShape* shape;
    std::uint32_t label;  ///< of most of its pixels
};

class ShapesReal : public testing::TestWithParam<std::string> {
protected:
    /// False where the data is missing.
    bool load() {
        const fs::path path = folder() / ("osd_" + GetParam() + ".pcd");
        if (!fs::exists(path)) return false;
        auto source = open_pcd_sequence(path);
        if (!source) return false;
        EXPECT_TRUE((*source)->next(frame, std::chrono::milliseconds(0)));
        labels = labels_of(path);
        detector.emplace(ShapeDetector::create((*source)->info().camera).value());
        shapes = detector->detect(frame.depth);
        for (const auto& shape : shapes) {
            std::map<std::uint32_t, int> votes;
            for (const auto pixel : shape.pixels)
                ++votes[labels[pixel]];
            const auto most =
                std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                    return a.second < b.second;
                });
            labelled.push_back({&shape, most->first});
            right += most->second;
            given += static_cast<double>(shape.pixels.size());
        }
        for (std::size_t i = 0; i < labels.size(); ++i)
            if (labels[i] > 0 && frame.depth[i] != 0)
                (labels[i] == kTable ? table : objects) += 1.0;
        return true;
    }

    RgbdFrame frame;
    std::vector<std::uint32_t> labels;
    std::optional<ShapeDetector> detector;
    std::span<const SceneShape> shapes;
    std::vector<Labelled> labelled;
    double right = 0.0, given = 0.0, table = 0.0, objects = 0.0;
};

TEST_P(ShapesReal, TableCansAndBoxesAgreeWithTheLabels) {
    if (!load()) GTEST_SKIP() << "no osd_" << GetParam() << ".pcd in " << folder();
    ASSERT_FALSE(labelled.empty());
    EXPECT_EQ(labelled[0].label, kTable);
    EXPECT_EQ(labelled[0].shape->fit.shape.kind, ShapeKind::plane);
    double of_table = 0.0, of_objects = 0.0;
    for (const auto& one : labelled) {
        double own = 0.0;
        for (const auto pixel : one.shape->pixels)
            own += labels[pixel] == one.label ? 1.0 : 0.0;
        if (one.label == kTable) of_table += own;
        if (one.label > kTable) of_objects += own;
    }
    const double precision = right / given;
    std::cout << GetParam() << ": precision " << precision << ", recall of the table "
              << of_table / table << ", of the objects " << of_objects / objects << '\n';
    EXPECT_GT(precision, 0.97);
    EXPECT_GT(of_table / table, 0.93);
    EXPECT_GT(of_objects / objects, 0.60);

    // Cans, cups and round tins stand upright: their axes are the table's normal.
    const Eigen::Vector3d up = labelled[0].shape->fit.shape.axis;
    for (const auto& one : labelled) {
        const Shape& shape = one.shape->fit.shape;
        if (shape.kind == ShapeKind::plane && one.shape->pixels.size() > 3000)
            for (const auto& other : labelled) {
                // Large faces of one thing are parallel or at right angles.
                const Shape& face = other.shape->fit.shape;
                if (face.kind != ShapeKind::plane || other.label != one.label ||
                    other.shape->pixels.size() <= 3000)
                    continue;
                const double cosine = std::abs(shape.axis.dot(face.axis));
                EXPECT_TRUE(cosine > 0.98 || cosine < 0.06) << one.label << ": " << cosine;
            }
    }
    int upright = 0;
    for (const auto& one : labelled)
        if (one.shape->fit.shape.kind == ShapeKind::cylinder &&
            std::abs(one.shape->fit.shape.axis.dot(up)) > 0.99)
            ++upright;
    const bool cans = GetParam() == "test31" || GetParam() == "test33" || GetParam() == "test36";
    if (cans) {
        EXPECT_GE(upright, 3);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Osd,
    ShapesReal,
    testing::Values(
        "learn5", "learn33", "learn38", "test0", "test31", "test33", "test36", "test47"
    ),
    [](const auto& info) { return info.param; }
);

}  // namespace
}  // namespace kinectlab
