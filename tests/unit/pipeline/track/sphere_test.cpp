#include "pipeline/track/sphere.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab {
namespace {

using test::Ball;
using test::BallRoom;

std::vector<std::uint32_t> pixels_of(const BallRoom& room, const Ball& ball) {
    std::vector<std::uint32_t> pixels;
    const Pinhole& k = room.camera.depth;
    for (int v = 0; v < k.height; ++v)
        for (int u = 0; u < k.width; ++u)
            if (room.distance(u, v, {ball}) != room.distance(u, v, {}))
                pixels.push_back(static_cast<std::uint32_t>(v * k.width + u));
    return pixels;
}

constexpr int kFrames = 15;

struct Seen {
    int tracked = 0;
    std::string why_lost;  // of the last frame in which it was
};

// A ball that swings a little, 1 to 2 m away.
Seen track(double true_radius, double radius_m, double distance_m, bool string_above = false) {
    BallRoom room(7);
    room.string_above = string_above;
    const auto tracker =
        make_sphere_tracker(room.camera, {{0, "bob", SphereSettings{.radius_m = radius_m}}});
    Seen seen;
    for (int i = 0; i < kFrames; ++i) {
        const Ball ball{{0.002 * i, 0.05, distance_m + 0.001 * i}, true_radius};
        const auto pixels = pixels_of(room, ball);
        const MovedPixels moved{pixels};
        std::vector<TrackSample> samples;
        tracker->track(room.frame({ball}), std::span(&moved, 1), samples);
        if (samples.at(0).status == TrackStatus::tracked)
            ++seen.tracked;
        else
            seen.why_lost = samples[0].quality.why_lost;
    }
    return seen;
}

TEST(Sphere, NoticesThatTheGivenRadiusIsNotTheBalls) {
    for (const double wrong : {0.92, 1.08, 0.8, 1.25}) {
        const Seen seen = track(0.05, 0.05 * wrong, 1.2);
        EXPECT_EQ(seen.tracked, 0) << wrong;
        EXPECT_NE(seen.why_lost, "") << wrong;
    }
    EXPECT_NE(track(0.05, 0.054, 1.2).why_lost.find("radius_m"), std::string::npos);
}

TEST(Sphere, KeepsABallWhoseRadiusIsRightOrNearlySo) {
    for (const double distance_m : {0.8, 2.0})
        for (const double nearly : {0.98, 1.02})
            for (const bool string_above : {false, true})
                EXPECT_EQ(track(0.05, 0.05 * nearly, distance_m, string_above).tracked, kFrames)
                    << distance_m << ' ' << nearly << ' ' << string_above;
    // Few pixels prove no radius, neither this nor that.
    EXPECT_EQ(track(0.03, 0.03, 2.5).why_lost.find("radius_m"), std::string::npos);
}

TEST(Sphere, SaysWhyItIsLost) {
    BallRoom room;
    const auto tracker =
        make_sphere_tracker(room.camera, {{0, "bob", SphereSettings{.radius_m = 0.05}}});
    std::vector<TrackSample> samples;
    tracker->track(room.frame({}), {}, samples);
    EXPECT_EQ(samples.at(0).quality.why_lost, "nothing moved");
}

}  // namespace
}  // namespace kinectlab
