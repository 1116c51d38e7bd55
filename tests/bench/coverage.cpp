#include <cmath>
#include <future>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/coverage_runs.hpp"
#include "tests/bench/measurements.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kSeeds = 200;
constexpr std::size_t kOften = 150;  // runs: a result that few runs give is a choice of those
constexpr double kWithinU = 68.0;    // %, the middle of 60 to 76
constexpr double kWithin2U = 94.5;   // %, the middle of 90 to 99

struct Scene {
    const char* name;
    const char* method;
    CoverageRun (*make)(std::uint64_t seed, PositionNoise noise);
};

constexpr Scene kScenes[] = {
    {"thrown ball", "projectile", thrown_ball},
    {"rolling ball", "incline", rolling_ball},
    {"sliding ball", "incline", sliding_ball},
    {"free spring", "spring", free_spring},
    {"driven spring", "spring", driven_spring},
};

/// Errors in units of u, by result.
using Errors = std::map<std::string, std::vector<double>>;

void one_run(const Scene& scene, PositionNoise noise, int seed, Errors& errors) {
    const CoverageRun run = scene.make(static_cast<std::uint64_t>(seed), noise);
    const auto out =
        analyse(scene.method, std::span(&run.trajectory, 1), run.settings, run.conditions);
    if (!out) {
        errors["(refused)"].push_back(1e9);
        return;
    }
    const auto truth = run.truth(out->facts.at("start_s"));
    for (const auto& m : out->measurements)
        errors[m.name].push_back((m.value - truth.at(m.name)) / m.u);
}

/// Two halves of the seeds at once.
Errors over_seeds(const Scene& scene, PositionNoise noise) {
    const auto half = [&](int first) {
        Errors errors;
        for (int seed = first; seed <= kSeeds; seed += 2)
            one_run(scene, noise, seed, errors);
        return errors;
    };
    auto other = std::async(std::launch::async, half, 2);
    Errors errors = half(1);
    for (auto& [name, values] : other.get())
        errors[name].insert(errors[name].end(), values.begin(), values.end());
    return errors;
}

double share_within(const std::vector<double>& errors, double limit) {
    double inside = 0.0;
    for (const double e : errors)
        inside += std::abs(e) <= limit ? 1.0 : 0.0;
    return 100.0 * inside / static_cast<double>(errors.size());
}

}  // namespace

Figures measure_coverage() {
    Figures figures;
    for (const Scene& scene : kScenes)
        for (const PositionNoise noise : {PositionNoise::white, PositionNoise::lasting})
            for (const auto& [name, errors] : over_seeds(scene, noise)) {
                const std::string row =
                    std::string("coverage, ") + scene.name + ", " + name +
                    (noise == PositionNoise::white ? ", white noise" : ", lasting noise");
                const double one = share_within(errors, 1.0);
                const double two = share_within(errors, 2.0);
                const bool often = errors.size() >= kOften;
                const auto bound = [&](double limit) {
                    return often ? std::optional(limit) : std::nullopt;
                };
                const auto add = [&](const char* what, double value, std::optional<double> limit) {
                    figures.push_back({row + what, value, "%", limit, Better::lower, {}, {}});
                };
                add(", within u", one, {});
                add(", within u: off 68", std::abs(one - kWithinU), bound(8.0));
                add(", within 2u", two, {});
                add(", within 2u: off 94.5", std::abs(two - kWithin2U), bound(4.5));
                figures.push_back(
                    {row + ", runs with it",
                     static_cast<double>(errors.size()),
                     "1",
                     {},
                     Better::higher,
                     {},
                     {}}
                );
            }
    return figures;
}

}  // namespace kinectlab::bench
