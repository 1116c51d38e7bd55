#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>

#include "pipeline/preprocess/preprocessing.hpp"
#include "pipeline/track/tracker.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_identities.hpp"
#include "tests/unit/pipeline/support/ball_room.hpp"

namespace kinectlab::bench {
namespace {

using test::Ball;
using test::BallRoom;

constexpr int kLearned = 5;
constexpr std::size_t kBalls = 3;  // the last may be a screen that is judged too

double now_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch()
    )
        .count();
}

struct Scenario {
    const char* name;
    std::vector<std::vector<Ball>> frames;
};

std::vector<Scenario> scenarios() {
    Scenario crossing{"crossing", {}}, touching{"touching", {}}, hiding{"hiding", {}};
    for (int i = -30; i <= 30; ++i)
        crossing.frames.push_back({{{0.02 * i, 0.01, 1.2}, 0.06}, {{-0.016 * i, -0.02, 1.7}, 0.06}}
        );
    const auto gap = [](int i) {
        return i < 20 ? 0.15 - 0.0045 * i : i < 50 ? 0.06 : 0.06 + 0.0045 * (i - 50);
    };
    for (int i = 0; i < 70; ++i)
        touching.frames.push_back({{{-gap(i), 0.0, 1.4}, 0.06}, {{gap(i), 0.0, 1.4}, 0.06}});
    for (int i = -45; i <= 45; ++i)
        hiding.frames.push_back(
            {{{0.013 * i, 0.0, 1.8}, 0.06}, {{-0.3, 0.32, 1.5}, 0.06}, {{0.0, 0.0, 0.9}, 0.15}}
        );
    return {crossing, touching, hiding};
}

struct Named {
    std::uint32_t name;
    Eigen::Vector3d p_cam;
};

/// Counts of Ristani et al. 2016 (IDF1) and Bernardin & Stiefelhagen 2008 (switches, fragments).
class Judge {
public:
    void frame(
        const std::vector<Ball>& balls, const std::vector<bool>& visible, std::vector<Named> named
    ) {
        told_ += static_cast<int>(named.size());
        for (std::size_t ball = 0; ball < balls.size(); ++ball) {
            const auto hit = std::min_element(named.begin(), named.end(), [&](auto& a, auto& b) {
                return (a.p_cam - balls[ball].centre_cam).norm() <
                       (b.p_cam - balls[ball].centre_cam).norm();
            });
            const bool found = hit != named.end() && (hit->p_cam - balls[ball].centre_cam).norm() <=
                                                         1.3 * balls[ball].radius;
            if (visible[ball] || found) ++true_;
            if (!found) {
                if (visible[ball] && last_[ball] != 0) broken_[ball] = true;
                continue;
            }
            ++agreed_[{ball, hit->name}];
            if (last_[ball] != 0 && last_[ball] != hit->name) ++switches_;
            fragments_ += broken_[ball] ? 1 : 0;
            broken_[ball] = false;
            last_[ball] = hit->name;
            named.erase(hit);
        }
    }
    [[nodiscard]] int switches() const { return switches_; }
    [[nodiscard]] int fragments() const { return fragments_; }
    /// Of the best pairing of balls and names over the whole time.
    [[nodiscard]] double idf1() const {
        std::set<std::uint32_t> names;
        for (const auto& [pair, count] : agreed_)
            names.insert(pair.second);
        const int best = pair_up(0, names);
        return 2.0 * best / std::max(1, true_ + told_);
    }
    [[nodiscard]] int pair_up(std::size_t ball, const std::set<std::uint32_t>& left) const {
        if (ball == kBalls) return 0;
        int best = pair_up(ball + 1, left);
        for (const auto name : left) {
            const auto count = agreed_.find({ball, name});
            if (count == agreed_.end()) continue;
            auto rest = left;
            rest.erase(name);
            best = std::max(best, count->second + pair_up(ball + 1, rest));
        }
        return best;
    }

private:
    std::map<std::pair<std::size_t, std::uint32_t>, int> agreed_;
    std::array<std::uint32_t, kBalls> last_{};
    std::array<bool, kBalls> broken_{};
    int true_ = 0, told_ = 0, switches_ = 0, fragments_ = 0;
};

/// A ball is to be told where at least a third of its outline's inside is seen.
std::vector<bool> visible_of(const BallRoom& room, const std::vector<Ball>& balls) {
    std::vector<bool> visible;
    for (const auto& ball : balls) {
        const Eigen::Vector2d middle = room.camera.depth.project(ball.centre_cam);
        const double radius = room.camera.depth.fx * ball.radius / ball.centre_cam.z();
        int seen = 0, all = 0;
        for (double y = -radius; y <= radius; y += 1.0)
            for (double x = -radius; x <= radius; x += 1.0) {
                if (x * x + y * y > radius * radius) continue;
                ++all;
                const double z = room.distance(
                    static_cast<int>(middle.x() + x), static_cast<int>(middle.y() + y), balls
                );
                seen += z > ball.centre_cam.z() - 1.1 * ball.radius &&
                                z < ball.centre_cam.z() + 0.1 * ball.radius
                            ? 1
                            : 0;
            }
        visible.push_back(3 * seen >= all);
    }
    return visible;
}

struct Result {
    int switches = 0, fragments = 0;
    double idf1 = 0.0, best_ms = 1e9;
};

struct Both {
    Result own, stock;
};

Both run(const Scenario& scenario) {
    BallRoom room(3);
    room.camera.depth = {320, 240, 262.5, 262.5, 159.5, 119.5};
    Preprocessing preprocessing(room.camera, {});
    RgbdFrame empty;
    for (int i = 0; i < kLearned; ++i)
        preprocessing.learn(empty = room.frame({}));
    const std::vector<ObjectSpec> objects{{"moved", ChangeTrackSettings{}}};
    const auto trackers = make_trackers(room.camera, objects).value();
    OpenCvNearestNames peer(room.camera, empty.depth);
    Judge own_judge, stock_judge;
    Both both;
    std::vector<TrackSample> samples;
    for (const auto& balls : scenario.frames) {
        const RgbdFrame frame = room.frame(balls);
        const auto visible = visible_of(room, balls);
        // Both from the depth picture to named places: change and segments are timed too.
        samples.clear();
        double start = now_ms();
        const auto moved = preprocessing.moved(frame).value();
        trackers.front()->track(frame, moved, samples);
        both.own.best_ms = std::min(both.own.best_ms, now_ms() - start);
        preprocessing.follow(frame);
        std::vector<Named> named;
        for (const auto& sample : samples)
            if (sample.status == TrackStatus::tracked)
                named.push_back({sample.identity, sample.p_cam});
        own_judge.frame(balls, visible, named);

        start = now_ms();
        const auto seen = peer.follow(frame);
        both.stock.best_ms = std::min(both.stock.best_ms, now_ms() - start);
        named.clear();
        for (const auto& one : seen)
            named.push_back({one.name, one.p_cam});
        stock_judge.frame(balls, visible, named);
    }
    const auto sum_up = [](const Judge& judge, Result& result) {
        result.switches = judge.switches();
        result.fragments = judge.fragments();
        result.idf1 = judge.idf1();
    };
    sum_up(own_judge, both.own);
    sum_up(stock_judge, both.stock);
    return both;
}

}  // namespace

Figures measure_identities() {
    const std::string cv = "OpenCV components, nearest neighbour";
    Figures figures;
    double own_ms = 1e9, stock_ms = 1e9;
    for (const auto& scenario : scenarios()) {
        const Both both = run(scenario);
        const std::string name = std::string("identities, ") + scenario.name;
        own_ms = std::min(own_ms, both.own.best_ms);
        stock_ms = std::min(stock_ms, both.stock.best_ms);
        figures.push_back(
            {name + ": IDF1",
             both.own.idf1,
             "1",
             both.stock.idf1,
             Better::higher,
             both.stock.idf1,
             cv}
        );
        const auto count = [&](const char* what, int own, int stock) {
            figures.push_back(
                {name + ": " + what,
                 static_cast<double>(own),
                 "1",
                 0.0,
                 Better::lower,
                 static_cast<double>(stock),
                 cv}
            );
        };
        count("names switched", both.own.switches, both.stock.switches);
        count("fragments", both.own.fragments, both.stock.fragments);
    }
    figures.push_back(
        {"identities: 320x240 depth to names", own_ms, "ms", {}, Better::lower, stock_ms, cv}
    );
    return figures;
}

}  // namespace kinectlab::bench
