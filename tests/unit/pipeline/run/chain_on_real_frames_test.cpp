#include <cstdlib>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "pipeline/sensor/recording.hpp"

namespace kinectlab {
namespace {

std::filesystem::path shared_data() {
    if (const char* given = std::getenv("KINECTLAB_SHARED_DATA")) return given;
    return std::filesystem::path(KINECTLAB_SOURCE_DIR) / "../shared/data";
}

struct Choice {
    const char* name;
    PreprocessSettings settings;
};

std::vector<Choice> choices() {
    std::vector<Choice> all(4);
    all[0].name = "Default";
    all[1].name = "Octree";
    all[1].settings.change.method = ChangeMethod::octree;
    all[2].name = "Smoothing";
    all[2].settings.smoothing = MovingLeastSquaresSettings{};
    all[3].name = "Outliers";
    all[3].settings.outliers = OutlierSettings{};
    return all;
}

class BoxesOnATable : public testing::TestWithParam<Choice> {};

/// Eleven frames of a real Xtion, the first of them the reference.
TEST_P(BoxesOnATable, ComeAndKeepTheirIdentities) {
    const auto folder = shared_data() / "xtion_boxes";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no recordings of real sensors at " << folder;
    auto source = open_recording(folder);
    ASSERT_TRUE(source) << to_text(source.error());
    const ObjectSpec moved{"moved", ChangeTrackSettings{}};
    auto chain = Chain::create({(*source)->info().camera, {moved}, GetParam().settings});
    ASSERT_TRUE(chain) << to_text(chain.error());

    RgbdFrame frame;
    std::map<std::uint32_t, std::vector<Eigen::Vector3d>> places;
    for (int number = 1; number <= 11; ++number) {
        const auto status = (*source)->next(frame, std::chrono::milliseconds(1000));
        ASSERT_TRUE(status) << to_text(status.error());
        ASSERT_EQ(*status, FrameStatus::frame);
        if (number == 1) {
            ASSERT_TRUE(chain->learn(frame));
            continue;
        }
        const auto samples = chain->track(frame);
        ASSERT_TRUE(samples);
        EXPECT_EQ(samples->size(), number <= 8 ? 0U : 2U) << "frame " << number;
        for (const auto& sample : *samples) {
            EXPECT_EQ(sample.status, TrackStatus::tracked) << "frame " << number;
            EXPECT_GT(sample.quality.points, 1000) << "frame " << number;
            places[sample.identity].push_back(sample.p_cam);
        }
    }
    // The brown box, the larger one, came first and stays; the yellow one, right of it, is moved
    // away.
    ASSERT_EQ(places.size(), 2U);
    ASSERT_EQ(places[1].size(), 3U);
    ASSERT_EQ(places[2].size(), 3U);
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_LT((places[1][i] - places[1][0]).norm(), 0.005);
        EXPECT_GT(places[2][i].z(), places[2][i - 1].z() + 0.05);
        EXPECT_GT(places[2][i].x(), places[1][i].x() + 0.15);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, BoxesOnATable, testing::ValuesIn(choices()), [](const auto& info) {
    return info.param.name;
});

}  // namespace
}  // namespace kinectlab
