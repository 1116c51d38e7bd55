#include <algorithm>
#include <cmath>
#include <future>
#include <iostream>
#include <map>
#include <string>

#include "tests/bench/body_runs.hpp"
#include "tests/bench/measurements.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kSeeds = 200;
using MakeRun = BodyRun (*)(std::uint64_t seed, BodyNoise noise);

struct Share {
    double within_u = 0.0;
    double within_2u = 0.0;
};

struct Coverage {
    std::map<std::string, Share> shares;
    double greatest_rate_error = 0.0;  // of the angular velocity vector, relative
    int refused = 0;

    void add(const BodyRun& run) {
        AnalysisConditions exact;
        exact.depth_scale_u = exact.clock_u = exact.tilt_u_rad = 0.0;
        const auto outcome = analyse(run.method, run.objects, run.settings, exact);
        if (!outcome) {
            std::cerr << "refused: " << to_text(outcome.error()) << '\n';
            ++refused;
            return;
        }
        double off = 0.0;
        double size = 0.0;
        for (const auto& m : outcome->measurements) {
            const auto truth = run.truth.find(m.name);
            if (truth == run.truth.end()) continue;
            const double error = m.value - truth->second;
            shares[m.name].within_u += std::abs(error) <= m.u ? 1.0 / kSeeds : 0.0;
            shares[m.name].within_2u += std::abs(error) <= 2.0 * m.u ? 1.0 / kSeeds : 0.0;
            if (!m.name.starts_with("rate_")) continue;
            off += error * error;
            size += truth->second * truth->second;
        }
        if (size > 0.0) greatest_rate_error = std::max(greatest_rate_error, std::sqrt(off / size));
    }

    void add(const Coverage& other) {
        for (const auto& [name, share] : other.shares) {
            shares[name].within_u += share.within_u;
            shares[name].within_2u += share.within_2u;
        }
        greatest_rate_error = std::max(greatest_rate_error, other.greatest_rate_error);
        refused += other.refused;
    }
};

Coverage over_seeds(MakeRun make, BodyNoise noise) {
    const auto every_second = [&](int first) {
        Coverage some;
        for (int seed = first; seed <= kSeeds; seed += 2)
            some.add(make(static_cast<std::uint64_t>(seed), noise));
        return some;
    };
    auto other = std::async(std::launch::async, every_second, 2);
    Coverage all = every_second(1);
    all.add(other.get());
    return all;
}

Figures coverage(const std::string& name, MakeRun make) {
    Figures figures;
    for (const BodyNoise noise : {BodyNoise::white, BodyNoise::slow}) {
        const std::string start =
            "coverage bodies, " + name + (noise == BodyNoise::white ? ", white" : ", slow") + ", ";
        const Coverage all = over_seeds(make, noise);
        Share greatest;
        const auto add = [&](const std::string& what, double value, double bound, Better better) {
            figures.push_back({start + what, value, "1", bound, better, {}, {}});
        };
        for (const auto& [result, share] : all.shares) {
            add(result + " within u", share.within_u, 0.60, Better::higher);
            add(result + " within 2u", share.within_2u, 0.90, Better::higher);
            greatest.within_u = std::max(greatest.within_u, share.within_u);
            greatest.within_2u = std::max(greatest.within_2u, share.within_2u);
        }
        add("greatest share within u", greatest.within_u, 0.76, Better::lower);
        add("greatest share within 2u", greatest.within_2u, 0.99, Better::lower);
        add("refused", all.refused, 0.0, Better::lower);
        if (all.greatest_rate_error > 0.0)
            add("angular velocity, largest error", all.greatest_rate_error, 0.01, Better::lower);
    }
    return figures;
}

}  // namespace

Figures measure_coverage_bodies() {
    Figures figures;
    const std::pair<const char*, MakeRun> kinds[] = {
        {"collision", collision_run}, {"rigid body", tumbler_run}, {"path", robot_run}};
    for (const auto& [name, make] : kinds) {
        const Figures some = coverage(name, make);
        figures.insert(figures.end(), some.begin(), some.end());
    }
    return figures;
}

}  // namespace kinectlab::bench
