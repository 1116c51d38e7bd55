#include <map>
#include <set>

#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

using test::Ball;
using test::BallRoom;

/// Which thing each ball was taken for, frame by frame, judged by where the balls truly are.
class Followed {
public:
    explicit Followed(std::vector<ObjectSpec> objects, int learned = 5) {
        // Half the Kinect's resolution: a quarter of the time.
        room.camera.depth = {320, 240, 262.5, 262.5, 159.5, 119.5};
        ChainSettings settings;
        settings.camera = room.camera;
        settings.objects = std::move(objects);
        chain_.emplace(std::move(Chain::create(settings).value()));
        for (int i = 0; i < learned; ++i)
            EXPECT_TRUE(chain_->learn(room.frame({})));
    }

    void show(const std::vector<Ball>& balls) { show(room.frame(balls), balls); }

    void show(const RgbdFrame& frame, const std::vector<Ball>& balls) {
        const auto samples = chain_->track(frame).value();
        last.assign(samples.begin(), samples.end());
        names_.resize(balls.size());
        tracked_.resize(balls.size());
        std::vector<std::uint32_t> now(balls.size(), 0);
        for (const auto& sample : samples) {
            if (sample.status != TrackStatus::tracked) continue;
            for (std::size_t i = 0; i < balls.size(); ++i) {
                const double far = (sample.p_cam - balls[i].centre_cam).norm();
                if (far > 1.3 * balls[i].radius) continue;
                const auto name = sample.identity > 0 ? sample.identity : sample.object + 1;
                names_[i].insert(name);
                ++tracked_[i];
            }
        }
    }

    [[nodiscard]] std::set<std::uint32_t> names(std::size_t ball) const { return names_[ball]; }
    [[nodiscard]] int tracked(std::size_t ball) const { return tracked_[ball]; }
    [[nodiscard]] std::size_t lost() const {
        std::size_t count = 0;
        for (const auto& sample : last)
            count += sample.status == TrackStatus::lost ? 1 : 0;
        return count;
    }

    BallRoom room;
    std::vector<TrackSample> last;
    Chain& chain() { return *chain_; }

private:
    std::optional<Chain> chain_;
    std::vector<std::set<std::uint32_t>> names_;
    std::vector<int> tracked_;
};

std::vector<ObjectSpec> whatever_moves() {
    return {{"moved", ChangeTrackSettings{}}};
}
std::vector<ObjectSpec> two_balls() {
    return {{"a", SphereSettings{.radius_m = 0.06}}, {"b", SphereSettings{.radius_m = 0.06}}};
}

class Identities : public testing::TestWithParam<std::vector<ObjectSpec>> {
protected:
    /// Each ball had one name all the time, and the two names differ.
    static void expect_one_name_each(const Followed& followed) {
        EXPECT_EQ(followed.names(0).size(), 1U);
        EXPECT_EQ(followed.names(1).size(), 1U);
        EXPECT_NE(followed.names(0), followed.names(1));
    }
};

TEST_P(Identities, SurviveACrossing) {
    Followed followed(GetParam());
    for (int i = -30; i <= 30; ++i)
        followed.show({{{0.02 * i, 0.01, 1.2}, 0.06}, {{-0.016 * i, -0.02, 1.7}, 0.06}});
    expect_one_name_each(followed);
    EXPECT_EQ(followed.tracked(0), 61) << "the one in front is seen all the time";
    EXPECT_GT(followed.tracked(1), 50);
}

TEST_P(Identities, SurviveATouchOfASecondAndABounce) {
    Followed followed(GetParam());
    const auto gap = [](int i) {
        return i < 20 ? 0.15 - 0.0045 * i : i < 50 ? 0.06 : 0.06 + 0.0045 * (i - 50);
    };
    for (int i = 0; i < 70; ++i)
        followed.show({{{-gap(i), 0.0, 1.4}, 0.06}, {{gap(i), 0.0, 1.4}, 0.06}});
    expect_one_name_each(followed);
    EXPECT_GT(followed.tracked(0), 60);
    EXPECT_GT(followed.tracked(1), 60);
}

TEST_P(Identities, SurviveBeingHiddenForASecond) {
    Followed followed(GetParam());
    // A third ball, far larger, stands before the path; 0.3 m/s, hidden for about a second.
    const Ball before{{0.0, 0.0, 0.9}, 0.15};
    int hidden = 0;
    for (int i = -45; i <= 45; ++i) {
        const Ball behind{{0.013 * i, 0.0, 1.8}, 0.06};
        const Ball other{{-0.3, 0.32, 1.5}, 0.06};
        followed.show({behind, other, before});
        hidden += followed.lost() > 0 ? 1 : 0;
    }
    expect_one_name_each(followed);
    EXPECT_EQ(followed.tracked(1), 91);
    EXPECT_GE(hidden, 25) << "it is hidden for about a second";
    EXPECT_GT(followed.tracked(0), 20);
}

INSTANTIATE_TEST_SUITE_P(
    Of,
    Identities,
    testing::Values(whatever_moves(), two_balls()),
    [](const auto& info) { return info.param.size() == 1 ? "WhateverMoves" : "BallsOfOneSize"; }
);

TEST(IdentitiesOfThings, ABarInTheSceneDoesNotCutAThingInTwo) {
    Followed followed(whatever_moves(), 0);
    const auto with_bar = [&](const std::vector<Ball>& balls) {
        RgbdFrame frame = followed.room.frame(balls);
        for (int v = 0; v < 240; ++v)
            for (int u = 155; u < 161; ++u)
                frame.depth[static_cast<std::size_t>(v * 320 + u)] = followed.room.noisy(0.9);
        return frame;
    };
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(followed.chain().learn(with_bar({})));
    for (int i = -20; i <= 20; ++i) {
        const std::vector<Ball> balls{{{0.015 * i, 0.0, 1.4}, 0.10}};
        followed.show(with_bar(balls), balls);
        EXPECT_EQ(followed.last.size(), 1U) << i;
    }
    EXPECT_EQ(followed.names(0), std::set<std::uint32_t>{1});
    EXPECT_EQ(followed.tracked(0), 41);
}

/// A bob that hung in its place while the reference was learned: there it is a gap.
TEST(IdentitiesOfThings, RestingInTheReferencesOwnPlaceIsAGapAndNotAnEnd) {
    Followed followed(whatever_moves(), 0);
    const Ball at_rest{{0.0, 0.0, 1.5}, 0.06};
    for (int i = 0; i < 20; ++i)
        ASSERT_TRUE(followed.chain().learn(followed.room.frame({at_rest})));
    followed.show({at_rest});
    EXPECT_TRUE(followed.last.empty()) << "it has not moved yet";
    // Away for less time than closes the hole that it leaves, and back.
    for (int i = 1; i <= 12; ++i)
        followed.show({{{0.02 * std::min(i, 12 - i), 0.0, 1.5}, 0.06}});
    int gaps = 0;
    for (int i = 0; i < 15; ++i) {
        followed.show({at_rest});
        ASSERT_EQ(followed.last.size(), 1U);
        gaps += followed.last.front().status == TrackStatus::lost ? 1 : 0;
    }
    EXPECT_GE(gaps, 13);
    for (int i = 1; i <= 12; ++i)
        followed.show({{{0.02 * i, 0.0, 1.5}, 0.06}});
    EXPECT_EQ(followed.last.front().identity, 1U);
    EXPECT_EQ(followed.last.front().status, TrackStatus::tracked);
    EXPECT_EQ(followed.names(0), std::set<std::uint32_t>{1});
}

TEST(IdentitiesOfThings, WhatStaysAwayIsForgotten) {
    Followed followed({{"moved", ChangeTrackSettings{.memory_s = 0.5}}});
    for (int i = 0; i < 5; ++i)
        followed.show({{{0.0, 0.0, 1.5}, 0.06}});
    for (int i = 0; i < 10; ++i)
        followed.show(std::vector<Ball>{});
    EXPECT_EQ(followed.lost(), 1U);
    for (int i = 0; i < 10; ++i)
        followed.show(std::vector<Ball>{});
    EXPECT_TRUE(followed.last.empty());
    followed.show({{{0.0, 0.0, 1.5}, 0.06}});
    EXPECT_EQ(followed.last.front().identity, 2U);
    followed.chain().reset();
    ASSERT_TRUE(followed.chain().learn(followed.room.frame({})));
    followed.show({{{0.0, 0.0, 1.5}, 0.06}});
    EXPECT_EQ(followed.last.front().identity, 1U) << "after a reset numbers begin anew";
}

TEST(IdentitiesOfThings, AHiddenPartMakesThePlaceUnsure) {
    Followed followed(whatever_moves());
    double whole = 0.0, half = 0.0;
    for (int i = 0; i < 40; ++i) {
        const Ball behind{{-0.30 + 0.01 * i, 0.0, 1.8}, 0.06};
        followed.show({{{0.0, 0.0, 0.9}, 0.10}, behind});
        for (const auto& sample : followed.last) {
            if (sample.p_cam.z() < 1.4) continue;
            const double u = std::sqrt(sample.covariance(0, 0));
            if (i == 0) whole = u;
            half = std::max(half, u);
            EXPECT_LT((sample.p_cam - behind.centre_cam).norm(), 0.06 + 4.0 * u) << i;
        }
    }
    EXPECT_LT(whole, 0.003);
    EXPECT_GT(half, 0.01);
}

TEST(IdentitiesOfThings, RefusesAMemoryOutOfRange) {
    for (const double memory_s : {-1.0, 61.0, std::nan("")}) {
        ChainSettings settings;
        settings.objects = {{"moved", ChangeTrackSettings{.memory_s = memory_s}}};
        EXPECT_EQ(Chain::create(settings).error().field, "objects[0].memory_s") << memory_s;
    }
}

}  // namespace
}  // namespace kinectlab
