#include <numeric>

#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

// With noise: no bias, an uncertainty that is the scatter, nothing lost against the bound.

namespace kinectlab::testing {
namespace {

struct Scatter {
    double mean = 0.0;  // of the errors over the seeds
    double scatter = 0.0;
    double u = 0.0;      // mean of the stated ones
    double worst = 0.0;  // error over u
    double outliers = 0.0;
};

using Spoil = std::function<void(Trajectory&, std::mt19937_64&)>;

Scatter over_seeds(
    const Swing& s, int seeds, const Spoil& spoil = [](auto&, auto&) {}
) {
    const Trajectory clean = generate(s);
    std::vector<double> errors;
    Scatter all;
    for (int seed = 1; seed <= seeds; ++seed) {
        Trajectory path = with_noise(clean, static_cast<unsigned>(seed));
        std::mt19937_64 random(static_cast<unsigned>(seed) + 1000);
        spoil(path, random);
        const auto result = analyse_pendulum(path, exact_settings(s));
        if (!result) {
            ADD_FAILURE() << "seed " << seed << ": " << to_text(result.error());
            continue;
        }
        const Measurement& g = named(*result, "g");
        errors.push_back(g.value - s.g);
        all.u += g.u / seeds;
        all.worst = std::max(all.worst, std::abs(errors.back()) / g.u);
        all.outliers += static_cast<double>(result->fit.outliers) / seeds;
    }
    all.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / seeds;
    for (const double e : errors)
        all.scatter += (e - all.mean) * (e - all.mean) / (seeds - 1);
    all.scatter = std::sqrt(all.scatter);
    return all;
}

void expect_honest(const Scatter& all, int seeds) {
    EXPECT_LT(std::abs(all.mean), 3.5 * all.scatter / std::sqrt(seeds)) << "bias";
    const double known_to = 2.0 / std::sqrt(2.0 * seeds);  // how well so few know their scatter
    EXPECT_LT(all.u, 1.5 * (1.0 + known_to) * all.scatter);
    EXPECT_GT(all.u, all.scatter / (1.5 * (1.0 + known_to)));
    EXPECT_LT(all.worst, 3.5);
}

/// FACTS: var(ω) >= 24σ²/(A²N(N²-1)), rad²/sample², for the lateral axis alone; σ_g/g = 2σ_ω/ω.
double bound_of_g(const Swing& s, double sigma) {
    const double a = s.length * std::sin(s.amplitude_deg * std::numbers::pi / 180.0);
    const double n = s.seconds * s.rate;
    const double omega = std::sqrt(s.g / s.length);
    return 2.0 * s.g / omega * s.rate * std::sqrt(24.0 * sigma * sigma / (a * a * n * (n * n - 1)));
}

constexpr int kSeeds = 16;

TEST(PendulumNoise, ReachesTheBoundInWhiteNoise) {
    const Swing s{.damping = 0.0, .seconds = 12.0};
    const Scatter all = over_seeds(s, 40);
    expect_honest(all, 40);
    const double bound = bound_of_g(s, 5e-4);
    constexpr double kScatterKnown = 0.11;  // 1/sqrt(2 * 40): how well 40 seeds know their scatter
    EXPECT_LT(all.scatter, 1.1 * (1.0 + kScatterKnown) * bound);
    EXPECT_GT(all.u, 0.95 * bound) << "nothing is better than the bound";
    EXPECT_LT(all.u, 1.15 * bound);
    EXPECT_LT(all.outliers, 1.0);
}

TEST(PendulumNoise, HighDamping) {
    expect_honest(
        over_seeds({.amplitude_deg = 20, .damping = 0.2, .seconds = 12.0}, kSeeds), kSeeds
    );
}

TEST(PendulumNoise, WideEllipse) {
    expect_honest(over_seeds({.sideways = 0.3, .seconds = 12.0}, kSeeds), kSeeds);
}

TEST(PendulumNoise, HeldAndReleased) {
    expect_honest(over_seeds({.seconds = 12.0, .rest = 1.0, .held = 1.0}, kSeeds), kSeeds);
}

TEST(PendulumNoise, GapsOfSeconds) {
    const Spoil gaps = [](Trajectory& path, auto&) {
        for (std::size_t i = 0; i < path.samples.size(); ++i)
            if (i / 90 % 3 == 1) path.samples[i].status = TrackStatus::lost;
    };
    expect_honest(over_seeds({.seconds = 20.0}, kSeeds, gaps), kSeeds);
}

TEST(PendulumNoise, MostFramesLost) {
    const Spoil lose = [](Trajectory& path, std::mt19937_64& random) {
        for (auto& m : path.samples)
            if (random() % 10 < 7) m.status = TrackStatus::lost;
    };
    expect_honest(over_seeds({.seconds = 20.0}, kSeeds, lose), kSeeds);
}

TEST(PendulumNoise, OneInTenIsWild) {
    const Spoil wild = [](Trajectory& path, std::mt19937_64& random) {
        std::normal_distribution<double> far(0.0, 0.3);
        for (auto& m : path.samples)
            if (random() % 10 == 0)
                m.p_lab += Eigen::Vector3d(far(random), far(random), far(random));
    };
    const Scatter all = over_seeds({.seconds = 12.0}, kSeeds, wild);
    expect_honest(all, kSeeds);
    EXPECT_NEAR(all.outliers, 36.0, 8.0);
}

TEST(PendulumNoise, NoiseThatStaysForFramesWidensU) {
    const Spoil slow = [](Trajectory& path, std::mt19937_64& random) {
        std::normal_distribution<double> push(0.0, 1e-3);
        Eigen::Vector3d drift = Eigen::Vector3d::Zero();
        for (auto& m : path.samples) {
            drift = 0.8 * drift + Eigen::Vector3d(push(random), push(random), push(random));
            m.p_lab += drift;
        }
    };
    expect_honest(over_seeds({}, kSeeds, slow), kSeeds);
}

TEST(PendulumNoise, CovariancesTooSmallDoNotMakeUTooSmall) {
    const Spoil boast = [](Trajectory& path, auto&) {
        for (auto& m : path.samples)
            m.covariance *= 0.01;
    };
    expect_honest(over_seeds({.seconds = 12.0}, kSeeds, boast), kSeeds);
}

}  // namespace
}  // namespace kinectlab::testing
