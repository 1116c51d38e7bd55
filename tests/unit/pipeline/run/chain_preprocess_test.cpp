#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

using test::Ball;
using test::BallRoom;

/// A quarter of the Kinect's pixels, so that slow methods are quick as well.
BallRoom small_room() {
    BallRoom room;
    room.camera.depth = {320, 240, 262.5, 262.5, 159.5, 119.5};
    return room;
}

Chain chain_for(const BallRoom& room, const PreprocessSettings& preprocess) {
    return std::move(
        Chain::create({room.camera, {{"moved", ChangeTrackSettings{}}}, preprocess}).value()
    );
}

/// Things that are tracked in this frame.
std::vector<TrackSample> seen(Chain& chain, const RgbdFrame& frame) {
    std::vector<TrackSample> seen;
    const auto samples = chain.track(frame).value();
    for (const auto& sample : samples)
        if (sample.status == TrackStatus::tracked) seen.push_back(sample);
    return seen;
}

struct Choice {
    const char* name;
    PreprocessSettings settings;
};

std::vector<Choice> choices() {
    std::vector<Choice> all(9);
    all[0].name = "Default";
    all[1].name = "Rolling";
    all[1].settings.reference = {ReferenceMethod::rolling, 2.0};
    all[2].name = "Median";
    all[2].settings.reference = {ReferenceMethod::median, 0.5};
    all[3].name = "Octree";
    all[3].settings.change.method = ChangeMethod::octree;
    all[4].name = "OctreeRolling";
    all[4].settings.change.method = ChangeMethod::octree;
    all[4].settings.reference = {ReferenceMethod::rolling, 2.0};
    all[5].name = "FixedCut";
    all[5].settings.depth_cut = {CutMethod::fixed, 2.0};
    all[6].name = "NoCut";
    all[6].settings.depth_cut.method = CutMethod::none;
    all[7].name = "Outliers";
    all[7].settings.outliers = OutlierSettings{.neighbours = 20, .sigma_factor = 3.0};
    all[8].name = "Smoothing";
    all[8].settings.smoothing = MovingLeastSquaresSettings{};
    return all;
}

class EveryChoice : public testing::TestWithParam<Choice> {};

TEST_P(EveryChoice, FindsABallThatCrossesTheRoomAndNothingElse) {
    BallRoom room = small_room();
    Chain chain = chain_for(room, GetParam().settings);
    for (int i = 0; i < 15; ++i)
        ASSERT_TRUE(chain.learn(room.frame({})));
    for (int i = 0; i < 3; ++i)
        EXPECT_TRUE(seen(chain, room.frame({})).empty()) << i;
    for (int i = -6; i <= 6; ++i) {
        const Ball ball{{0.03 * i, 0.0, 1.5}, 0.08};
        const auto found = seen(chain, room.frame({ball}));
        ASSERT_EQ(found.size(), 1U) << i;
        EXPECT_EQ(found.front().identity, 1U);
        // The centroid of what is seen lies two thirds of the radius before the centre.
        const Eigen::Vector3d surface =
            ball.centre_cam - 0.667 * 0.08 * ball.centre_cam.normalized();
        EXPECT_LT((found.front().p_cam - surface).norm(), 0.012) << i;
    }
}

TEST_P(EveryChoice, FramesWithoutReadingsShowNothing) {
    BallRoom room = small_room();
    Chain chain = chain_for(room, GetParam().settings);
    RgbdFrame blank = room.frame({});
    std::fill(blank.depth.begin(), blank.depth.end(), std::uint16_t{0});
    ASSERT_TRUE(chain.learn(blank));
    EXPECT_TRUE(seen(chain, blank).empty());
    blank.depth[1000] = 1;  // one reading, absurdly near
    EXPECT_TRUE(seen(chain, blank).empty());
}

INSTANTIATE_TEST_SUITE_P(Of, EveryChoice, testing::ValuesIn(choices()), [](const auto& info) {
    return info.param.name;
});

TEST(ChainPreprocess, TheRollingBackgroundTakesInWhatRests) {
    BallRoom room = small_room();
    PreprocessSettings settings;
    settings.reference = {ReferenceMethod::rolling, 1.0};
    Chain chain = chain_for(room, settings);
    for (int i = 0; i < 30; ++i)
        ASSERT_TRUE(chain.learn(room.frame({})));
    const Ball ball{{0.1, 0.0, 1.5}, 0.08};
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(seen(chain, room.frame({ball})).size(), 1U) << i;
    for (int i = 0; i < 30; ++i)
        (void)seen(chain, room.frame({ball}));
    EXPECT_TRUE(seen(chain, room.frame({ball})).empty()) << "it has become the scene";
    EXPECT_EQ(seen(chain, room.frame({ball, {{-0.2, 0.0, 1.5}, 0.08}})).size(), 1U);
}

TEST(ChainPreprocess, TheMedianIsBlindToWhatPassesInTheFirstSeconds) {
    BallRoom room = small_room();
    PreprocessSettings settings;
    settings.reference = {ReferenceMethod::median, 1.0};
    Chain chain = chain_for(room, settings);
    for (int i = 0; i < 31; ++i)
        ASSERT_TRUE(chain.learn(room.frame({{{-0.3 + 0.02 * i, 0.0, 1.5}, 0.08}})));
    for (int i = 0; i < 31; ++i)
        EXPECT_EQ(seen(chain, room.frame({{{-0.3 + 0.02 * i, 0.0, 1.5}, 0.08}})).size(), 1U) << i;
}

/// The device warms up: everything it sees comes nearer, a tenth of a step of disparity in a
/// second, until twice the threshold is passed.
void expect_blind_to_drift(const PreprocessSettings& settings) {
    BallRoom room;
    room.camera.depth = {80, 60, 65.0, 65.0, 39.5, 29.5};
    Chain chain = chain_for(room, settings);
    for (int i = 0; i < 31; ++i)
        ASSERT_TRUE(chain.learn(room.frame({})));
    const double at_first = 1.0 / room.wall_m;
    for (int i = 0; i < 2400; ++i) {
        room.wall_m = 1.0 / (at_first + i * 0.1 / 30.0 * room.step);
        ASSERT_TRUE(seen(chain, room.frame({})).empty()) << "frame " << i;
    }
    EXPECT_EQ(seen(chain, room.frame({{{0.0, 0.0, 1.2}, 0.2}})).size(), 1U);
}

TEST(ChainPreprocess, SlowDriftTriggersNothing) {
    for (const auto method :
         {ReferenceMethod::scene, ReferenceMethod::rolling, ReferenceMethod::median}) {
        SCOPED_TRACE(static_cast<int>(method));
        PreprocessSettings settings;
        settings.reference = {method, 1.0};
        expect_blind_to_drift(settings);
    }
}

TEST(ChainPreprocess, SlowDriftTriggersNothingInVoxels) {
    PreprocessSettings settings;
    settings.change.method = ChangeMethod::octree;
    settings.depth_cut.method = CutMethod::none;  // the wall itself is looked at
    expect_blind_to_drift(settings);
}

/// From 4 m on a Kinect's noise (26 mm at 4 m, 105 mm at 8 m) carries readings out of voxels of
/// 50 mm.
TEST(ChainPreprocess, VoxelsNarrowerThanTheNoiseTriggerNothing) {
    for (const double wall_m : {3.2, 4.0, 6.0, 8.0}) {
        BallRoom room = small_room();
        room.wall_m = wall_m;
        PreprocessSettings settings;
        settings.change.method = ChangeMethod::octree;
        settings.depth_cut.method = CutMethod::none;
        Chain chain = chain_for(room, settings);
        for (int i = 0; i < 15; ++i)
            ASSERT_TRUE(chain.learn(room.frame({})));
        for (int i = 0; i < 20; ++i)
            ASSERT_TRUE(seen(chain, room.frame({})).empty()) << wall_m << " m, frame " << i;
        EXPECT_EQ(seen(chain, room.frame({{{0.1, 0.0, 1.5}, 0.08}})).size(), 1U) << wall_m;
    }
}

TEST(ChainPreprocess, AFixedCutHidesWhatIsFarther) {
    BallRoom room = small_room();
    room.wall_m = 0.0;
    PreprocessSettings settings;
    settings.depth_cut = {CutMethod::fixed, 1.6};
    Chain chain = chain_for(room, settings);
    ASSERT_TRUE(chain.learn(room.frame({})));
    EXPECT_EQ(seen(chain, room.frame({{{0.0, 0.0, 1.5}, 0.08}})).size(), 1U);
    EXPECT_TRUE(seen(chain, room.frame({{{0.0, 0.0, 1.8}, 0.08}})).empty());
}

struct WrongSetting {
    const char* field;
    void (*spoil)(PreprocessSettings&);
};

TEST(ChainPreprocess, RefusesSettingsOutOfRange) {
    const BallRoom room = small_room();
    for (const WrongSetting& wrong : {
             WrongSetting{
                 "outliers.neighbours",
                 [](auto& s) {
                     s.outliers = {.neighbours = 0};
                 }},
             WrongSetting{
                 "outliers.neighbours",
                 [](auto& s) {
                     s.outliers = {.neighbours = 5000};
                 }},
             WrongSetting{
                 "outliers.sigma_factor",
                 [](auto& s) {
                     s.outliers = {100, -1.0};
                 }},
             WrongSetting{
                 "smoothing.radius_m",
                 [](auto& s) {
                     s.smoothing = {.radius_m = -0.1};
                 }},
             WrongSetting{
                 "smoothing.epsilon_m",
                 [](auto& s) {
                     s.smoothing = {.epsilon_m = 0.0};
                 }},
             WrongSetting{
                 "depth_cut.farthest_m",
                 [](auto& s) {
                     s.depth_cut.farthest_m = 0.0;
                 }},
             WrongSetting{
                 "reference.seconds",
                 [](auto& s) {
                     s.reference.seconds = std::nan("");
                 }},
             WrongSetting{
                 "change.threshold_steps",
                 [](auto& s) {
                     s.change.threshold_steps = 0.0;
                 }},
             WrongSetting{
                 "change.voxel_m",
                 [](auto& s) {
                     s.change.voxel_m = -1.0;
                 }},
             WrongSetting{
                 "change.least_points",
                 [](auto& s) {
                     s.change.least_points = 0;
                 }},
             WrongSetting{
                 "segments.min_points",
                 [](auto& s) {
                     s.min_segment_points = 0;
                 }},
         }) {
        ChainSettings settings{room.camera, {{"moved", ChangeTrackSettings{}}}, {}};
        wrong.spoil(settings.preprocess);
        const auto chain = Chain::create(settings);
        ASSERT_FALSE(chain) << wrong.field;
        EXPECT_EQ(chain.error().field, std::string("preprocess.") + wrong.field);
    }
}

}  // namespace
}  // namespace kinectlab
