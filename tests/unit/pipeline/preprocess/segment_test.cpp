#include "pipeline/preprocess/segment.hpp"

#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "pipeline/core/disparity.hpp"
#include "pipeline/preprocess/change.hpp"

namespace kinectlab {
namespace {

/// A picture in which every reading counts as changed.
struct Picture {
    ChangeSettings settings;
    std::vector<std::uint16_t> depth, reach;
    std::vector<std::uint8_t> trusted;

    Picture(int width = 64, int height = 48) {
        settings.width = width;
        settings.height = height;
        settings.product = static_cast<float>(DisparityScale(RgbdCamera{}).product);
        depth.assign(static_cast<std::size_t>(width * height), 0);
        reach.assign(depth.size(), 65534);
        trusted.assign(depth.size(), 1);
    }
    void draw(int left, int top, int right, int bottom, std::uint16_t value) {
        for (int v = top; v < bottom; ++v)
            for (int u = left; u < right; ++u)
                depth[static_cast<std::size_t>(v * settings.width + u)] = value;
    }
    std::vector<std::size_t> sizes(int min_points = 20) {
        std::vector<ChangedRun> runs;
        find_changed(depth, reach, settings, runs);
        Segmenter segmenter(settings, min_points);
        std::vector<std::size_t> found;
        for (const auto& segment : segmenter.segment(depth, trusted, runs))
            found.push_back(segment.size());
        return found;
    }
};

using Sizes = std::vector<std::size_t>;

TEST(Change, IsNearerThanTheLimitAndNotMissing) {
    Picture picture;
    picture.draw(0, 0, 64, 48, 2000);
    picture.reach.assign(picture.reach.size(), 1999);  // the limit less one
    EXPECT_TRUE(picture.sizes().empty());
    picture.reach.assign(picture.reach.size(), 2000);
    EXPECT_EQ(picture.sizes(), Sizes{64 * 48});
    picture.draw(0, 0, 64, 48, 0);
    EXPECT_TRUE(picture.sizes().empty());
}

TEST(Change, ReachesTheLastPixelOfAnOddPicture) {
    Picture picture(61, 47);
    picture.draw(51, 37, 61, 47, 1500);
    EXPECT_EQ(picture.sizes(), Sizes{100});
}

TEST(Segment, BiggestFirstAndSpecklesGone) {
    Picture picture;
    picture.draw(2, 2, 10, 10, 1500);
    picture.draw(20, 20, 40, 40, 1500);
    picture.draw(50, 2, 52, 4, 1500);
    EXPECT_EQ(picture.sizes(), (Sizes{400, 64}));
}

TEST(Segment, APhantomInAHoleIsNotBelieved) {
    Picture picture;
    picture.draw(20, 20, 40, 40, 1500);
    std::fill(picture.trusted.begin(), picture.trusted.end(), std::uint8_t{0});
    EXPECT_TRUE(picture.sizes().empty());
    for (std::size_t i = 30 * 64; i < picture.trusted.size(); ++i)
        picture.trusted[i] = 1;
    EXPECT_EQ(picture.sizes(), Sizes{400}) << "half of it stands before something known";
}

TEST(Segment, DepthDividesWhatTouchesInThePicture) {
    Picture picture;
    picture.draw(10, 10, 20, 20, 1500);
    picture.draw(20, 10, 30, 20, 2500);
    EXPECT_EQ(picture.sizes(), (Sizes{100, 100}));
    picture.draw(20, 10, 30, 20, 1510);
    EXPECT_EQ(picture.sizes(), Sizes{200});
}

TEST(Segment, AThinStringIsNotPartOfTheBob) {
    Picture picture;
    picture.draw(20, 20, 40, 40, 1500);
    picture.draw(29, 0, 31, 20, 1500);
    EXPECT_EQ(picture.sizes(), Sizes{400});
}

TEST(Segment, ArmsThatMeetBelowAreOne) {
    Picture picture;
    picture.draw(10, 5, 16, 30, 1500);
    picture.draw(30, 5, 36, 30, 1500);
    picture.draw(10, 30, 36, 36, 1500);
    EXPECT_EQ(picture.sizes().size(), 1U);
}

RC_GTEST_PROP(Segment, EveryPixelBelongsToAtMostOneSegmentAndWasChanged, ()) {
    Picture picture(40, 30);
    const auto boxes = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 30 * 30 * 30));
    for (const int box : boxes) {
        const int left = box % 30, top = box / 30 % 30, kind = box / 900;
        const auto depth = static_cast<std::uint16_t>(kind % 3 * 700);
        picture.draw(
            left, top, std::min(40, left + 3 + kind / 3), std::min(30, top + 2 + kind / 2), depth
        );
    }
    std::vector<ChangedRun> runs;
    find_changed(picture.depth, picture.reach, picture.settings, runs);
    Segmenter segmenter(picture.settings, 12);
    std::set<std::uint32_t> seen;
    std::size_t last = SIZE_MAX;
    for (const auto& segment : segmenter.segment(picture.depth, picture.trusted, runs)) {
        RC_ASSERT(segment.size() >= 12U && segment.size() <= last);
        last = segment.size();
        for (const auto pixel : segment) {
            RC_ASSERT(picture.depth[pixel] != 0);
            RC_ASSERT(seen.insert(pixel).second);
        }
    }
}

}  // namespace
}  // namespace kinectlab
