#include "pipeline/preprocess/outliers.hpp"

#include <random>

#include "tests/bench/lab_scene.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_preprocess.hpp"
#include "tests/bench/preprocess_timing.hpp"

namespace kinectlab::bench {
namespace {

double differing(const Mask& a, const Mask& b) {
    double count = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += a[i] != b[i] ? 1.0 : 0.0;
    return count;
}

void compare(const std::string& name, const Cloud& cloud, bool wanted, Figures& figures) {
    const OutlierSettings settings;
    Outliers ours;
    const double ms = least_ms(5, [&] { ours = find_outliers(cloud, settings).value(); });
    const auto stock =
        stock_outliers(StockCloud(cloud), settings.neighbours, settings.sigma_factor);
    const auto bound = wanted ? std::optional(stock.ms / 30.0) : std::nullopt;
    figures.push_back(
        {"outliers K=100, " + name, ms, "ms", bound, Better::lower, stock.ms, "ms PCL"}
    );
    figures.push_back(
        {"outliers K=100, " + name + ": pixels that differ from PCL",
         differing(ours.mask, stock.value),
         "of " + std::to_string(ours.count),
         0.0,
         Better::lower,
         std::nullopt,
         ""}
    );
}

/// The same points without their picture.
Cloud scattered(const Cloud& cloud) {
    Cloud list = cloud;
    list.width = static_cast<int>(cloud.size());
    list.height = 1;
    return list;
}

/// Points anywhere in a cubic metre, as a merged scan would have them.
Cloud two_million() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> side(0.0F, 1.0F);
    Cloud cloud = blank_cloud(2'000'000, 1);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        cloud.x[i] = side(random);
        cloud.y[i] = side(random);
        cloud.z[i] = side(random);
    }
    return cloud;
}

}  // namespace

Figures measure_outliers() {
    Figures figures;
    const LabScene scene = lab_scene(simulate::NoiseModel::kinect);
    compare("simulated frame", scene.seen, true, figures);
    compare("simulated frame as a list", scattered(scene.seen), false, figures);
    for (const auto& real : real_clouds(2))
        compare("real frame " + real.name, real.cloud, true, figures);
    const Cloud many = two_million();
    const double many_ms = least_ms(1, [&] { (void)find_outliers(many, {}).value(); });
    figures.push_back(
        {"outliers K=100, two million points in a cubic metre",
         many_ms / 1e3,
         "s",
         std::nullopt,
         Better::lower,
         std::nullopt,
         ""}
    );
    return figures;
}

}  // namespace kinectlab::bench
