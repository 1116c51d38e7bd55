#pragma once

#include <vector>

#include "pipeline/analysis/smooth_path.hpp"

namespace kinectlab {

struct PathNumber {
    double value = 0.0;
    double u = 0.0;  ///< by the noise of the positions
};

/// What a smoothed path on the floor comes to.
struct PathNumbers {
    PathNumber length;          ///< m, noise does not lengthen it
    PathNumber greatest_speed;  ///< m/s
    PathNumber displacement;    ///< m, from the first place to the last
    PathNumber turn;            ///< rad, from the first heading to the last, left positive
    double gaps_s = 0.0;        ///< out of sight
    double gaps_u = 0.0;        ///< m, how much longer the path may be there than a straight line
    double smoothing_share = 0.0;  ///< by which the smoothing may have shortened the length
    double standing_share = 0.0;   ///< of the time
    // At the samples' times:
    std::vector<double> speed, speed_u;      ///< m/s; 0 where it stands
    std::vector<double> heading;             ///< rad, unwrapped; NaN where it is not known
    std::vector<double> turning, turning_u;  ///< rad/s; NaN where it is not known
};

/// Errors (bad_data): an object that never moves.
[[nodiscard]] Result<PathNumbers> path_numbers(const SmoothPath& path, double half_window_s);

}  // namespace kinectlab
