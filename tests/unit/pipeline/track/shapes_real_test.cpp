#include <algorithm>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/osd_frame.hpp"
#include "tests/unit/pipeline/support/shared_data.hpp"

namespace kinectlab {
namespace {

namespace fs = std::filesystem;
using test::kTableLabel;

fs::path folder() {
    return test::shared_data() / "pcl";
}

struct Labelled {
    const SceneShape* shape;
    std::uint32_t label;  ///< of most of its pixels
};

class ShapesReal : public testing::TestWithParam<std::string> {
protected:
    /// False where the data is missing.
    bool load() {
        const auto osd = test::osd_frame(folder() / ("osd_" + GetParam() + ".pcd"));
        if (!osd) return false;
        detector.emplace(ShapeDetector::create(osd->camera).value());
        const auto shapes = detector->detect(osd->frame.depth);
        agrees = test::agreement(*osd, shapes);
        for (std::size_t i = 0; i < shapes.size(); ++i)
            labelled.push_back({&shapes[i], agrees.label_of[i]});
        return true;
    }

    std::optional<ShapeDetector> detector;
    std::vector<Labelled> labelled;
    test::OsdAgreement agrees;
};

/// What stands round in each frame, by its label. Written down from the colour pictures, in which
/// every thing can be told by eye, with the labels laid over them: tins, cans and mugs, one of the
/// tins lying on its side (learn38, 40), and the outer sides of two plastic pots. All else is flat:
/// cartons, the table, lids. The bowl of learn33 (40 and 41) is a piece of a ball and no ball, the
/// carton of test47 (70) has a bent front; neither is any of the four shapes. No frame has a ball
/// or a cone.
std::vector<std::uint32_t> round_things(const std::string& frame) {
    if (frame == "learn33") return {20, 30, 50, 61};
    if (frame == "learn38") return {20, 30, 40, 50};
    if (frame == "test31") return {20, 30, 40};
    if (frame == "test33") return {20, 30, 40, 50};
    if (frame == "test36") return {20, 30, 40};
    if (frame == "test47") return {20, 40};
    return {};  // learn5, test0: two cartons each
}

TEST_P(ShapesReal, RoundIsWhatIsRoundAndNothingElse) {
    if (!load()) GTEST_SKIP() << "no osd_" << GetParam() << ".pcd in " << folder();
    std::vector<std::uint32_t> found;
    for (const auto& one : labelled) {
        const ShapeKind kind = one.shape->fit.shape.kind;
        if (kind == ShapeKind::plane) continue;
        EXPECT_EQ(kind, ShapeKind::cylinder)
            << "a " << name_of(kind) << " on the thing with label " << one.label;
        found.push_back(one.label);
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, round_things(GetParam()));
}

TEST_P(ShapesReal, TableCansAndBoxesAgreeWithTheLabels) {
    if (!load()) GTEST_SKIP() << "no osd_" << GetParam() << ".pcd in " << folder();
    ASSERT_FALSE(labelled.empty());
    EXPECT_EQ(labelled[0].label, kTableLabel);
    EXPECT_EQ(labelled[0].shape->fit.shape.kind, ShapeKind::plane);
    std::cout << GetParam() << ": precision " << agrees.precision() << ", recall of the table "
              << agrees.recall_of_table() << ", of the objects " << agrees.recall_of_objects()
              << '\n';
    EXPECT_GT(agrees.precision(), 0.97);
    EXPECT_GT(agrees.recall_of_table(), 0.93);
    EXPECT_GT(agrees.recall_of_objects(), 0.60);

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
