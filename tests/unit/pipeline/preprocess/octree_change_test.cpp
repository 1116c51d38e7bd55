#include "pipeline/preprocess/octree_change.hpp"

#include <array>
#include <map>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/unit/pipeline/support/cloud_scenes.hpp"

namespace kinectlab {
namespace {

using namespace test;
using Cell = std::array<long, 3>;

/// Voxels have a corner at the first point less one voxel's edge: what PCL's first box has.
Cell cell_of(const Eigen::Vector3f& p, const Eigen::Vector3f& first, double voxel) {
    Cell cell;
    for (int k = 0; k < 3; ++k)
        cell[static_cast<std::size_t>(k)] = static_cast<long>(std::floor(
            (static_cast<double>(p[k]) - (static_cast<double>(first[k]) - voxel)) / voxel
        ));
    return cell;
}

/// Moves points that lie on the boundary of two voxels inside one: there rounding decides, and it
/// is compared with PCL's in the benchmark.
void leave_boundaries(
    std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& first, double voxel
) {
    for (auto& p : points)
        for (int k = 0; k < 3; ++k) {
            const double place =
                (static_cast<double>(p[k]) - static_cast<double>(first[k])) / voxel;
            if (std::abs(place - std::round(place)) < 1e-3) p[k] += static_cast<float>(0.1 * voxel);
        }
}

std::vector<std::uint8_t> expected_mask(
    const std::vector<Eigen::Vector3f>& reference,
    const std::vector<Eigen::Vector3f>& points,
    double voxel,
    int least
) {
    std::map<Cell, int> before, now;
    for (const auto& p : reference)
        ++before[cell_of(p, reference.front(), voxel)];
    for (const auto& p : points)
        ++now[cell_of(p, reference.front(), voxel)];
    std::vector<std::uint8_t> mask;
    for (const auto& p : points) {
        const Cell cell = cell_of(p, reference.front(), voxel);
        mask.push_back(before.count(cell) == 0 && now[cell] >= least ? 1 : 0);
    }
    return mask;
}

RC_GTEST_PROP(OctreeChange, FindsThePointsInVoxelsThatWereEmpty, (unsigned seed)) {
    auto reference = random_points(800, seed);
    auto points = random_points(1500, seed + 1);
    // Far outside the reference's box, too: it has to grow on all sides.
    for (std::size_t i = 0; i < points.size(); i += 7)
        points[i] *= 1.0F + 0.01F * static_cast<float>(i % 300);
    for (std::size_t i = 0; i < points.size(); i += 11)
        points[i] = -points[i];
    // Numbers that are exact in binary: the first point lies in a corner of voxels by construction.
    const double voxel = 0.03125 + 0.0078125 * static_cast<double>(seed % 5);
    const Eigen::Vector3f first(0.25F, -0.125F, 1.5F);
    leave_boundaries(points, first, voxel);
    leave_boundaries(reference, first, voxel);
    reference.insert(reference.begin(), first);
    const auto octree = OctreeReference::of(list_of(reference), voxel);
    RC_ASSERT(octree.has_value());
    for (const int least : {1, 2, 4}) {
        const auto change = octree->changed(list_of(points), least);
        RC_ASSERT(change.has_value());
        RC_ASSERT(change->mask == expected_mask(reference, points, voxel, least));
    }
}

TEST(OctreeChange, TheSameCloudHasNotChanged) {
    const Cloud scene = messy_scene(small_camera(), 1);
    const auto octree = OctreeReference::of(scene, 0.02);
    ASSERT_TRUE(octree);
    const auto change = octree->changed(scene);
    ASSERT_TRUE(change);
    EXPECT_EQ(change->count, 0U);
    EXPECT_GT(octree->voxels(), 100U);
}

TEST(OctreeChange, ABoardThatCameIsFoundAndNothingElse) {
    const auto wall = [](int, int, const Eigen::Vector3d&) {
        return 2.0;
    };
    const auto with_board = [](int u, int v, const Eigen::Vector3d&) {
        return u > 20 && u < 30 && v > 10 && v < 20 ? 1.5 : 2.0;
    };
    const auto octree = OctreeReference::of(render(small_camera(), wall), 0.05);
    ASSERT_TRUE(octree);
    const auto change = octree->changed(render(small_camera(), with_board));
    ASSERT_TRUE(change);
    EXPECT_EQ(change->count, 81U);
    EXPECT_EQ(change->mask[15 * 64 + 25], 1);
    EXPECT_EQ(change->mask[5 * 64 + 25], 0);
}

TEST(OctreeChange, AgainstNothingEverythingHasChanged) {
    const Cloud scene = messy_scene(small_camera(), 2);
    const auto octree = OctreeReference::of(blank_cloud(64, 48), 0.02);
    ASSERT_TRUE(octree);
    EXPECT_EQ(octree->voxels(), 0U);
    const auto change = octree->changed(scene);
    ASSERT_TRUE(change);
    for (std::size_t i = 0; i < scene.size(); ++i)
        EXPECT_EQ(change->mask[i] != 0, scene.valid(i));
    const auto nothing = octree->changed(Cloud{});
    ASSERT_TRUE(nothing);
    EXPECT_EQ(nothing->count, 0U);
}

TEST(OctreeChange, PartlyMissingCoordinatesAreNoReading) {
    Cloud cloud = list_of(random_points(100, 3));
    cloud.x[5] = kNone;
    cloud.z[6] = std::numeric_limits<float>::infinity();
    cloud.y[7] = kNone;
    cloud.x[7] = 1e30F;
    const auto octree = OctreeReference::of(list_of({{0, 0, 1}}), 0.01);
    const auto change = octree->changed(cloud);
    ASSERT_TRUE(change) << to_text(change.error());
    for (const std::size_t i : {5U, 6U, 7U})
        EXPECT_EQ(change->mask[i], 0);
    EXPECT_GE(change->count, 96U);
}

TEST(OctreeChange, TwoMillionPoints) {
    const Cloud cloud = list_of(random_points(2'000'000, 4));
    const auto octree = OctreeReference::of(cloud, 0.01);
    ASSERT_TRUE(octree);
    const auto change = octree->changed(cloud);
    ASSERT_TRUE(change);
    EXPECT_EQ(change->count, 0U);
}

TEST(OctreeChange, RefusesWhatCannotBe) {
    const Cloud cloud = list_of(random_points(20, 5));
    for (const double voxel : {0.0, -0.02, std::nan(""), HUGE_VAL}) {
        const auto octree = OctreeReference::of(cloud, voxel);
        ASSERT_FALSE(octree);
        EXPECT_EQ(octree.error().field, "voxel_m");
    }
    const auto fine = OctreeReference::of(cloud, 1e-7);
    ASSERT_FALSE(fine);
    EXPECT_EQ(fine.error().field, "voxel_m");
    const auto octree = OctreeReference::of(cloud, 0.02);
    ASSERT_TRUE(octree);
    EXPECT_EQ(octree->changed(cloud, 0).error().field, "least_points");
    EXPECT_EQ(octree->changed(list_of({{1e9F, 0, 0}})).error().field, "voxel_m");
    Cloud torn = cloud;
    torn.x.pop_back();
    EXPECT_EQ(octree->changed(torn).error().field, "cloud");
}

TEST(VoxelSet, KeepsEveryVoxelThroughGrowth) {
    VoxelSet set;
    std::map<Cell, bool> expected;
    std::mt19937 random(6);
    std::uniform_int_distribution<int> side(-300'000, 300'000);
    for (int n = 0; n < 20'000; ++n) {
        const int x = side(random), y = side(random), z = side(random) / 1000;
        set.insert(x, y, z);
        expected[{x, y, z}] = true;
    }
    EXPECT_EQ(set.size(), expected.size());
    for (const auto& [cell, yes] : expected) {
        const auto part = [&](std::size_t k) {
            return static_cast<std::int32_t>(cell[k]);
        };
        EXPECT_TRUE(set.contains(part(0), part(1), part(2)));
        EXPECT_EQ(
            set.contains(part(0) + 1, part(1), part(2)),
            expected.count({cell[0] + 1, cell[1], cell[2]}) != 0
        );
    }
}

}  // namespace
}  // namespace kinectlab
