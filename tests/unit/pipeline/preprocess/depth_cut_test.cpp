#include "pipeline/preprocess/depth_cut.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// A picture of disparities with noise, painted over from back to front.
class Scene {
public:
    Scene() : values(kWidth * kHeight, 0.0F) {}

    /// s = at_middle + per_column (u - middle) + per_row (v - middle) in columns [left, right),
    /// rows [top, bottom).
    Scene& plane(
        double at_middle,
        double per_column = 0.0,
        double per_row = 0.0,
        int left = 0,
        int right = kWidth,
        int top = 0,
        int bottom = kHeight
    ) {
        for (int v = top; v < bottom; ++v)
            for (int u = left; u < right; ++u) {
                const double s =
                    at_middle + per_column * (u - kWidth / 2) + per_row * (v - kHeight / 2);
                values[static_cast<std::size_t>(v * kWidth + u)] =
                    s > 0.0 ? static_cast<float>(s + noise_(random_)) : 0.0F;
            }
        return *this;
    }
    /// Clutter: every pixel anywhere between two disparities.
    Scene& clutter(double from_steps, double to_steps, int left, int right) {
        std::uniform_real_distribution<double> any(from_steps, to_steps);
        for (int v = 0; v < kHeight; ++v)
            for (int u = left; u < right; ++u)
                values[static_cast<std::size_t>(v * kWidth + u)] = static_cast<float>(any(random_));
        return *this;
    }
    Scene& without_readings(int left, int right) {
        for (int v = 0; v < kHeight; ++v)
            std::fill_n(values.begin() + v * kWidth + left, right - left, 0.0F);
        return *this;
    }
    [[nodiscard]] std::optional<DepthCut> cut() const { return wall_cut(values, kWidth); }

    /// Share of the readings in a rectangle that are kept.
    [[nodiscard]] double kept(int left, int right, int top, int bottom) const {
        const DepthCut cut = this->cut().value_or(DepthCut{});
        double readings = 0.0, kept = 0.0;
        for (int v = top; v < bottom; ++v)
            for (int u = left; u < right; ++u) {
                const float s = values[static_cast<std::size_t>(v * kWidth + u)];
                readings += 1.0;
                kept += s >= cut.steps(u, v) ? 1.0 : 0.0;
            }
        return kept / readings;
    }
    std::vector<float> values;

private:
    std::mt19937 random_{1};
    std::normal_distribution<double> noise_{0.0, 0.577};
};

TEST(DepthCut, LiesJustInFrontOfTheFarWall) {
    const auto cut =
        Scene().plane(110.5).clutter(150, 400, 0, 70).plane(220, 0, 0, 200, 240, 50, 150).cut();
    ASSERT_TRUE(cut);
    EXPECT_TRUE(cut->level());
    EXPECT_GT(cut->at_origin, 111.5);
    EXPECT_LT(cut->at_origin, 110.5 + 6);
}

TEST(DepthCut, ThinksNothingOfMissingReadings) {
    EXPECT_TRUE(Scene().plane(110.5).without_readings(80, 300).cut());
}

TEST(DepthCut, IsNotMadeWhereNoWallDominates) {
    EXPECT_FALSE(Scene().clutter(60, 400, 0, kWidth).cut()) << "clutter all over";
    EXPECT_FALSE(Scene().clutter(60, 400, 0, 300).plane(70, 0, 0, 300, kWidth).cut())
        << "a wall of a sixteenth of the picture";
    EXPECT_FALSE(Scene().cut()) << "no reading at all";
    EXPECT_FALSE(wall_cut({}, kWidth)) << "no picture";
}

TEST(DepthCut, IsNotMadeOfAFloor) {
    // 1 m below a level camera, seen up to the horizon: s = (v - horizon)/(f h step).
    EXPECT_FALSE(Scene().plane(0.0, 0.0, 0.67).cut());
}

TEST(DepthCut, SparesWhatIsSeenThroughADoor) {
    EXPECT_FALSE(Scene().plane(150.5).clutter(60, 120, 100, 160).cut());
}

struct Slant {
    double per_column, per_row;
};
class SlantedWall : public testing::TestWithParam<Slant> {};

/// The near end of the wall is nearer than what stands before its far end.
TEST_P(SlantedWall, IsCutAndNotWhatStandsBeforeIt) {
    const auto [per_column, per_row] = GetParam();
    Scene scene;
    scene.plane(115.0, per_column, per_row);
    scene.plane(124.0, per_column, per_row, 20, 60, 20, 60);
    scene.plane(124.0, per_column, per_row, 260, 300, 180, 220);
    const auto cut = scene.cut();
    ASSERT_TRUE(cut);
    EXPECT_NEAR(cut->per_column, per_column, 0.003);
    EXPECT_NEAR(cut->per_row, per_row, 0.003);
    EXPECT_GT(scene.kept(20, 60, 20, 60), 0.99);
    EXPECT_GT(scene.kept(260, 300, 180, 220), 0.99);
    EXPECT_LT(scene.kept(70, 250, 70, 170), 0.005);
    EXPECT_LT(scene.kept(0, 20, 0, kHeight), 0.005);
    EXPECT_LT(scene.kept(300, kWidth, 0, kHeight), 0.005);
}

INSTANTIATE_TEST_SUITE_P(
    Some,
    SlantedWall,
    testing::Values(
        Slant{0.02, 0.0},
        Slant{0.05, 0.0},
        Slant{-0.1, 0.0},
        Slant{0.25, 0.0},
        Slant{0.0, 0.3},
        Slant{0.12, -0.2},
        Slant{-0.3, 0.15}
    )
);

TEST(DepthCut, FindsASlantedWallBehindClutter) {
    const auto cut = Scene().plane(115.0, 0.15).clutter(180, 400, 0, 160).cut();
    ASSERT_TRUE(cut);
    EXPECT_NEAR(cut->per_column, 0.15, 0.005);
}

/// Shelves and pictures on the wall, of all depths from its surface on: the peak has no near foot.
TEST(DepthCut, KeepsWhatLiesOnTheWall) {
    for (const double slant : {0.0, 0.15}) {
        Scene scene;
        scene.plane(110.5, slant);
        for (int k = 0; k < 12; ++k)
            scene.plane(112.5 + k, slant, 0, 20 + 20 * k, 40 + 20 * k, 60, 160);
        ASSERT_TRUE(scene.cut()) << slant;
        EXPECT_GT(scene.kept(120, 140, 60, 160), 0.95) << slant << ": five steps before it";
        EXPECT_GT(scene.kept(140, 260, 60, 160), 0.99) << slant;
        EXPECT_LT(scene.kept(0, kWidth, 0, 60), 0.01) << slant;
    }
}

}  // namespace
}  // namespace kinectlab
