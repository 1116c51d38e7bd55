#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kinectlab {

/// One object to track, as given in {"objects":[…]} or by an experiment. Plain values here: JSON is
/// read by whoever has a file (server/experiments), the pipeline knows none.
struct ObjectSpec {
    std::string name;                ///< of the object, e.g. "bob"
    std::string method = "sphere";   ///< sphere | change
    std::optional<double> radius_m;  ///< sphere: known radius; free if absent
    double min_radius_m = 0.01;      ///< sphere, radius free
    double max_radius_m = 0.30;      ///< sphere, radius free
};

}  // namespace kinectlab
