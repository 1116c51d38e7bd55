#include "pipeline/preprocess/outliers.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/cloud_scenes.hpp"

namespace kinectlab {
namespace {

using namespace test;

/// Mean distance to the K nearest by trying all pairs, rounded as find_outliers documents.
float mean_by_brute_force(const Cloud& cloud, std::size_t i, int k) {
    std::vector<float> squared;
    for (std::size_t j = 0; j < cloud.size(); ++j) {
        if (j == i || !cloud.valid(j)) continue;
        const float dx = cloud.x[j] - cloud.x[i];
        const float dy = cloud.y[j] - cloud.y[i];
        const float dz = cloud.z[j] - cloud.z[i];
        squared.push_back(dx * dx + dy * dy + dz * dz);
    }
    std::nth_element(squared.begin(), squared.begin() + (k - 1), squared.end());
    double sum = 0.0;
    for (int n = 0; n < k; ++n)
        sum += static_cast<double>(std::sqrt(squared[static_cast<std::size_t>(n)]));
    return static_cast<float>(sum / k);
}

void expect_brute_force(const Cloud& cloud, int k, const std::string& what, std::size_t step = 1) {
    const auto found = find_outliers(cloud, {k, 1.0});
    ASSERT_TRUE(found) << to_text(found.error());
    for (std::size_t i = 0; i < cloud.size(); i += step) {
        const float expected = cloud.valid(i) ? mean_by_brute_force(cloud, i, k) : 0.0F;
        ASSERT_EQ(found->mean_distance[i], expected) << what << ", K = " << k << ", point " << i;
    }
}

TEST(Outliers, MeanDistancesAreThoseOfAllPairs) {
    const Cloud scene = messy_scene(small_camera(), 1);
    for (const int k : {1, 8, 50, 100}) {
        expect_brute_force(scene, k, "organised");
        expect_brute_force(as_list(scene), k, "list");
    }
}

TEST(Outliers, PicturesMayBeMirroredUpsideDownOrBehindTheOrigin) {
    const Cloud scene = messy_scene(small_camera(40, 30), 2);
    for (int flips = 1; flips < 8; ++flips) {
        Cloud flipped = scene;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            if ((flips & 1) != 0) flipped.x[i] = -flipped.x[i];
            if ((flips & 2) != 0) flipped.y[i] = -flipped.y[i];
            if ((flips & 4) != 0) flipped.z[i] = -flipped.z[i];
        }
        expect_brute_force(flipped, 20, "flips " + std::to_string(flips));
    }
}

TEST(Outliers, AGridThatIsNoPictureIsSearchedAllTheSame) {
    Cloud scattered = list_of(random_points(1200, 3));
    scattered.width = 40;
    scattered.height = 30;
    expect_brute_force(scattered, 10, "random points said to be organised");
    for (std::size_t i = 0; i < scattered.size(); i += 2)
        scattered.z[i] = -scattered.z[i];
    expect_brute_force(scattered, 10, "points before and behind the origin");
}

TEST(Outliers, AloneInMidAirIsAnOutlier) {
    Cloud wall = render(small_camera(), [](int, int, const auto&) { return 2.0; });
    const std::size_t flying = 20 * 64 + 30;
    wall.x[flying] *= 0.5F;
    wall.y[flying] *= 0.5F;
    wall.z[flying] *= 0.5F;
    const auto found = find_outliers(wall, {30, 3.0});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->mask[flying], 1);
    clear_points(wall, found->mask);
    EXPECT_FALSE(wall.valid(flying));
    EXPECT_EQ(
        found->count,
        static_cast<std::size_t>(std::count(found->mask.begin(), found->mask.end(), 1))
    );
}

TEST(Outliers, AFewPointsOrManyThatAreFarFromAllOthers) {
    for (const int every : {1500, 7}) {
        int seen = 0;
        const Cloud sparse = render(small_camera(), [&](int u, int, const auto&) {
            ++seen;
            return seen % every == 0 ? 0.4 + 0.01 * (seen % 50) : (u < 20 ? 3.0 : 0.0);
        });
        expect_brute_force(sparse, 30, "one point of " + std::to_string(every), 3);
    }
}

TEST(Outliers, DepthInLayersAsASensorGivesIt) {
    int seen = 0;
    const Cloud layers = render(small_camera(), [&](int, int, const auto&) {
        seen = (seen * 75 + 74) % 65537;
        return 3.0 + 0.03 * (seen % 4);
    });
    for (const int k : {5, 40, 100})
        expect_brute_force(layers, k, "layers", 5);
}

TEST(Outliers, APictureOfEqualPoints) {
    Cloud equal = blank_cloud(64, 48);
    std::fill(equal.x.begin(), equal.x.end(), 0.1F);
    std::fill(equal.y.begin(), equal.y.end(), 0.2F);
    std::fill(equal.z.begin(), equal.z.end(), 1.0F);
    const auto found = find_outliers(equal, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->count, 0U);
    EXPECT_EQ(found->threshold_m, 0.0);
}

TEST(Outliers, ThresholdIsMeanPlusFactorTimesDeviation) {
    const Cloud scene = as_list(messy_scene(small_camera(), 4));
    const auto found = find_outliers(scene, {20, 1.5});
    ASSERT_TRUE(found);
    double n = 0.0, mean = 0.0, squares = 0.0, all = 0.0;
    for (std::size_t i = 0; i < scene.size(); ++i)
        n += scene.valid(i) ? 1.0 : 0.0;
    for (const double d : found->mean_distance)
        mean += d / n;
    for (const double d : found->mean_distance) {
        squares += d * d;
        all += 1.0;
    }
    const double deviation = std::sqrt((squares - n * mean * mean) / (n - 1.0));
    EXPECT_NEAR(found->threshold_m, mean + 1.5 * deviation, 1e-7);
    for (std::size_t i = 0; i < scene.size(); ++i)
        EXPECT_EQ(found->mask[i] != 0, found->mean_distance[i] > found->threshold_m);
}

TEST(Outliers, ManyEqualPointsTakeNoLongerThanOthers) {
    const Cloud equal = list_of(std::vector<Eigen::Vector3f>(200'000, {0.1F, 0.2F, 1.0F}));
    const auto found = find_outliers(equal, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->count, 0U);
    EXPECT_EQ(found->threshold_m, 0.0);
}

TEST(Outliers, PointsInALineAndPairsOfEqualPoints) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 500; ++i)
        for (int twice = 0; twice < 2; ++twice)
            points.emplace_back(0.01F * static_cast<float>(i), 0.0F, 1.0F);
    expect_brute_force(list_of(points), 1, "pairs in a line");
    expect_brute_force(list_of(points), 16, "pairs in a line");
}

TEST(Outliers, NothingToSeeMeansNoOutliers) {
    const auto none = find_outliers(blank_cloud(64, 48), {});
    ASSERT_TRUE(none);
    EXPECT_EQ(none->count, 0U);
    EXPECT_EQ(none->mask.size(), 64U * 48U);
    EXPECT_TRUE(find_outliers(Cloud{}, {}));
}

TEST(Outliers, RefusesWhatCannotBe) {
    const Cloud few = list_of(random_points(50, 5));
    const auto error_of = [](const auto& result) {
        return result ? Error{} : result.error();
    };
    EXPECT_EQ(error_of(find_outliers(few, {50, 1.0})).field, "neighbours");
    EXPECT_NE(error_of(find_outliers(few, {50, 1.0})).message.find("only 50"), std::string::npos);
    EXPECT_TRUE(find_outliers(few, {49, 1.0}));
    EXPECT_EQ(error_of(find_outliers(list_of({{0, 0, 1}}), {1, 1.0})).field, "neighbours");
    EXPECT_EQ(error_of(find_outliers(few, {0, 1.0})).field, "neighbours");
    EXPECT_EQ(error_of(find_outliers(few, {-3, 1.0})).field, "neighbours");
    EXPECT_EQ(error_of(find_outliers(few, {5, -1.0})).field, "sigma_factor");
    EXPECT_EQ(error_of(find_outliers(few, {5, std::nan("")})).field, "sigma_factor");
    Cloud torn = few;
    torn.z.pop_back();
    EXPECT_EQ(error_of(find_outliers(torn, {5, 1.0})).field, "cloud");
}

TEST(Outliers, RealFramesAgreeWithAllPairsAndAsALists) {
    const auto path = shared_data("pcl/osd_learn5.pcd");
    if (path.empty()) GTEST_SKIP() << "needs the shared data: set KINECTLAB_SHARED_DATA";
    const auto cloud = read_pcd(path);
    ASSERT_TRUE(cloud) << to_text(cloud.error());
    const auto found = find_outliers(*cloud, {});
    ASSERT_TRUE(found) << to_text(found.error());
    const auto list = find_outliers(as_list(*cloud), {});
    ASSERT_TRUE(list);
    EXPECT_EQ(found->mean_distance, list->mean_distance);
    EXPECT_EQ(found->mask, list->mask);
    for (std::size_t i = 0; i < cloud->size(); i += 9973)
        if (cloud->valid(i)) {
            EXPECT_EQ(found->mean_distance[i], mean_by_brute_force(*cloud, i, 100));
        }
}

}  // namespace
}  // namespace kinectlab
