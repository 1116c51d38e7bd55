#include "pipeline/preprocess/moving_least_squares.hpp"

#include <cmath>

#include "tests/bench/lab_scene.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_preprocess.hpp"
#include "tests/bench/preprocess_timing.hpp"

namespace kinectlab::bench {
namespace {

/// Root mean square distance to the true surface over the pixels that `counts`, mm.
template <class PointAt, class Counts>
double rms_mm(const LabScene& scene, PointAt point_at, Counts counts) {
    double squares = 0.0, n = 0.0;
    for (std::size_t i = 0; i < scene.seen.size(); ++i) {
        if (!counts(i)) continue;
        const Eigen::Vector3f p = point_at(i);
        const double off = scene.off_surface(i, p.x(), p.y(), p.z());
        squares += off * off;
        n += 1.0;
    }
    return 1e3 * std::sqrt(squares / n);
}

void compare(simulate::NoiseModel noise, const std::string& name, Figures& figures) {
    const LabScene scene = lab_scene(noise);
    const MovingLeastSquaresSettings settings;
    const auto stock = stock_smoothed(StockCloud(scene.seen), settings.radius_m, 2);
    Smoothed ours;
    const double ms = least_ms(5, [&] {
        ours = smooth_organised(scene.seen, scene.camera.depth, settings).value();
    });
    const auto at = [](const Cloud& cloud) {
        return [&cloud](std::size_t i) {
            return Eigen::Vector3f(cloud.x[i], cloud.y[i], cloud.z[i]);
        };
    };
    const auto both = [&](std::size_t i) {
        return scene.on_surface(i) && stock.value[i].allFinite();
    };
    const double stock_rms = rms_mm(
        scene, [&](std::size_t i) { return stock.value[i]; }, both
    );
    figures.push_back(
        {"moving least squares, quadratic, 20 mm, " + name,
         ms,
         "ms",
         stock.ms / 50.0,
         Better::lower,
         stock.ms,
         "ms PCL"}
    );
    figures.push_back(
        {"moving least squares, " + name + ": RMS to truth",
         rms_mm(scene, at(ours.cloud), both),
         "mm",
         stock_rms,
         Better::lower,
         stock_rms,
         "mm PCL"}
    );
    figures.push_back(
        {"moving least squares, " + name + ": RMS before",
         rms_mm(scene, at(scene.seen), both),
         "mm",
         std::nullopt,
         Better::lower,
         std::nullopt,
         ""}
    );
    MovingLeastSquaresSettings linear = settings;
    linear.basis = Basis::linear;
    const double linear_ms = least_ms(5, [&] {
        ours = smooth_organised(scene.seen, scene.camera.depth, linear).value();
    });
    figures.push_back(
        {"moving least squares, linear, 20 mm, " + name,
         linear_ms,
         "ms",
         std::nullopt,
         Better::lower,
         std::nullopt,
         ""}
    );
    figures.push_back(
        {"moving least squares, linear, " + name + ": RMS to truth",
         rms_mm(scene, at(ours.cloud), both),
         "mm",
         std::nullopt,
         Better::lower,
         std::nullopt,
         ""}
    );
    const double list_ms =
        least_ms(1, [&] { ours = smooth_unorganised(scene.seen, settings).value(); });
    figures.push_back(
        {"moving least squares, quadratic, as a list, " + name,
         list_ms,
         "ms",
         std::nullopt,
         Better::lower,
         stock.ms,
         "ms PCL"}
    );
    figures.push_back(
        {"moving least squares, as a list, " + name + ": RMS to truth",
         rms_mm(scene, at(ours.cloud), both),
         "mm",
         std::nullopt,
         Better::lower,
         stock_rms,
         "mm PCL"}
    );
}

}  // namespace

Figures measure_moving_least_squares() {
    Figures figures;
    compare(simulate::NoiseModel::kinect, "kinect noise", figures);
    compare(simulate::NoiseModel::khoshelham, "khoshelham noise", figures);
    return figures;
}

}  // namespace kinectlab::bench
