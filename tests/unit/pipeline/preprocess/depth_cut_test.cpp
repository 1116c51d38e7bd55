#include "pipeline/preprocess/depth_cut.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

/// Disparities of a scene put together of surfaces.
class Scene {
public:
    Scene& add(int pixels, double from_steps, double to_steps, double noise_steps = 0.577) {
        std::uniform_real_distribution<double> along(from_steps, to_steps);
        std::normal_distribution<double> noise(0.0, noise_steps);
        for (int i = 0; i < pixels; ++i)
            values.push_back(static_cast<float>(along(random_) + noise(random_)));
        return *this;
    }
    std::vector<float> values;

private:
    std::mt19937 random_{1};
};

TEST(DepthCut, LiesJustInFrontOfTheFarWall) {
    const auto scene = Scene().add(200000, 110, 111).add(60000, 150, 400).add(20000, 219, 222);
    const auto cut = wall_cut_steps(scene.values);
    ASSERT_TRUE(cut);
    EXPECT_GT(*cut, 111);
    EXPECT_LT(*cut, 111 + 5);
}

TEST(DepthCut, ThinksNothingOfMissingReadings) {
    auto scene = Scene().add(100000, 110, 111);
    scene.values.resize(300000, 0.0F);
    EXPECT_TRUE(wall_cut_steps(scene.values));
}

TEST(DepthCut, IsNotMadeWhereNoWallDominates) {
    EXPECT_FALSE(wall_cut_steps(Scene().add(200000, 60, 400).values)) << "a room seen along it";
    EXPECT_FALSE(wall_cut_steps(Scene().add(200000, 80, 140).values)) << "a slanted wall";
    EXPECT_FALSE(wall_cut_steps({})) << "no reading at all";
}

TEST(DepthCut, SparesWhatIsSeenThroughADoor) {
    const auto scene = Scene().add(150000, 150, 151).add(30000, 60, 120);
    EXPECT_FALSE(wall_cut_steps(scene.values));
}

}  // namespace
}  // namespace kinectlab
