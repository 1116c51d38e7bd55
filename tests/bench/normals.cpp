#include "pipeline/features/normals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/bench/lab_scene.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_preprocess.hpp"
#include "tests/bench/preprocess_timing.hpp"

namespace kinectlab::bench {
namespace {

constexpr double kStockSize_px = 17.0;  // as wide as our window

struct AngleError {
    double mean_deg = 0.0;
    double median_deg = 0.0;
    double share = 0.0;  ///< of the readings on a surface that have a normal
};

/// `also` limits the pixels to those where the other method has a normal as well.
template <class NormalAt, class Also>
AngleError angle_error(const LabScene& scene, NormalAt normal_at, Also also) {
    std::vector<double> angles;
    double readings = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < scene.seen.size(); ++i) {
        if (!scene.on_surface(i)) continue;
        readings += 1.0;
        const Eigen::Vector3f normal = normal_at(i);
        if (!normal.allFinite() || !also(i)) continue;
        const double cosine = std::clamp<double>(normal.dot(scene.true_normal[i]), -1.0, 1.0);
        angles.push_back(std::acos(cosine) * 180.0 / std::numbers::pi);
        sum += angles.back();
    }
    const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
    std::nth_element(angles.begin(), middle, angles.end());
    const auto n = static_cast<double>(angles.size());
    return {sum / n, *middle, n / readings};
}

void compare(
    const LabScene& scene,
    const std::string& noise,
    StockNormals method,
    const std::string& name,
    Figures& figures
) {
    NormalImage ours;
    const double ms =
        least_ms(7, [&] { ours = find_normals(scene.seen, scene.camera.depth).value(); });
    const StockCloud cloud(scene.seen);
    Timed<std::vector<Eigen::Vector3f>> stock;
    stock.ms = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 3; ++round)
        if (auto timed = stock_normals(cloud, method, kStockSize_px); timed.ms < stock.ms)
            stock = std::move(timed);

    const auto our_normal = [&](std::size_t i) {
        return Eigen::Vector3f(ours.x[i], ours.y[i], ours.z[i]);
    };
    const auto stock_normal = [&](std::size_t i) {
        return stock.value[i];
    };
    const auto ours_too = [&](std::size_t i) {
        return std::isfinite(ours.x[i]);
    };
    const auto stock_too = [&](std::size_t i) {
        return stock.value[i].allFinite();
    };
    const auto all = [](std::size_t) {
        return true;
    };
    const AngleError our_error = angle_error(scene, our_normal, stock_too);
    const AngleError stock_error = angle_error(scene, stock_normal, ours_too);
    const std::string peer = " PCL " + name;
    figures.push_back(
        {"normals, " + noise, ms, "ms", stock.ms / 5.0, Better::lower, stock.ms, "ms" + peer}
    );
    figures.push_back(
        {"normals, " + noise + ": mean angle error where both have one",
         our_error.mean_deg,
         "deg",
         stock_error.mean_deg,
         Better::lower,
         stock_error.mean_deg,
         "deg" + peer}
    );
    figures.push_back(
        {"normals, " + noise + ": median angle error where both have one",
         our_error.median_deg,
         "deg",
         stock_error.median_deg,
         Better::lower,
         stock_error.median_deg,
         "deg" + peer}
    );
    figures.push_back(
        {"normals, " + noise + ": share of readings with one",
         angle_error(scene, our_normal, all).share,
         "",
         std::nullopt,
         Better::higher,
         angle_error(scene, stock_normal, all).share,
         peer.substr(1)}
    );
}

}  // namespace

Figures measure_normals() {
    Figures figures;
    const LabScene kinect = lab_scene(simulate::NoiseModel::kinect, 0.4);
    compare(kinect, "kinect noise", StockNormals::gradient, "3-D gradient", figures);
    compare(kinect, "kinect noise", StockNormals::covariance, "covariance", figures);
    compare(kinect, "kinect noise", StockNormals::depth_change, "depth change", figures);
    const LabScene plain = lab_scene(simulate::NoiseModel::khoshelham, 0.4);
    compare(plain, "khoshelham noise", StockNormals::gradient, "3-D gradient", figures);
    return figures;
}

}  // namespace kinectlab::bench
