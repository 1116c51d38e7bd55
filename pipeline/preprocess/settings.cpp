#include "pipeline/preprocess/settings.hpp"

#include <cmath>
#include <string>

#include "pipeline/core/number_text.hpp"

namespace kinectlab {
namespace {

struct Bound {
    const char* field;
    double value, least, most;
    const char* cure;
};

Result<void> check(const Bound& bound) {
    const bool inside =
        std::isfinite(bound.value) && bound.value >= bound.least && bound.value <= bound.most;
    if (inside) return {};
    return fail(
        ErrorCode::invalid_argument,
        std::string("preprocess.") + bound.field,
        "is " + number_text(bound.value),
        bound.cure
    );
}

}  // namespace

Result<void> check(const PreprocessSettings& settings) {
    constexpr double kLeast = 1e-4;
    const OutlierSettings outliers = settings.outliers.value_or(OutlierSettings{});
    const MovingLeastSquaresSettings smoothing =
        settings.smoothing.value_or(MovingLeastSquaresSettings{});
    for (const Bound& bound : {
             Bound{
                 "outliers.neighbours",
                 static_cast<double>(outliers.neighbours),
                 1.0,
                 OutlierSettings::kMostNeighbours,
                 "give a number of neighbours from 1 to 4096, e.g. 100"},
             Bound{
                 "outliers.sigma_factor",
                 outliers.sigma_factor,
                 0.0,
                 100.0,
                 "give standard deviations from 0 to 100, e.g. 1"},
             Bound{"smoothing.radius_m", smoothing.radius_m, kLeast, 0.2, "give metres, e.g. 0.02"},
             Bound{
                 "smoothing.epsilon_m",
                 smoothing.epsilon_m,
                 kLeast,
                 1.0,
                 "give metres, e.g. the radius"},
             Bound{
                 "depth_cut.farthest_m",
                 settings.depth_cut.farthest_m,
                 0.01,
                 60.0,
                 "give metres, e.g. 4"},
             Bound{
                 "reference.seconds",
                 settings.reference.seconds,
                 0.01,
                 3600.0,
                 "give seconds above 0 and up to 3600, e.g. 2"},
             Bound{
                 "change.threshold_steps",
                 settings.change.threshold_steps,
                 0.01,
                 1000.0,
                 "give disparity steps above 0, e.g. 4"},
             Bound{"change.voxel_m", settings.change.voxel_m, 1e-3, 1.0, "give metres, e.g. 0.05"},
             Bound{
                 "change.least_points",
                 static_cast<double>(settings.change.least_points),
                 1.0,
                 1e6,
                 "give points, 1 or more"},
             Bound{
                 "segments.min_points",
                 static_cast<double>(settings.min_segment_points),
                 1.0,
                 1e6,
                 "give points, 1 or more"},
         })
        if (auto ok = check(bound); !ok) return ok;
    return {};
}

}  // namespace kinectlab
