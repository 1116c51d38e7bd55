#pragma once

#include <string>

#include "pipeline/analysis/analysis.hpp"

namespace kinectlab::commands {

/// object,t_ns,x,y,z,fit_x,fit_y,fit_z,residual_x,residual_y,residual_z in metres, lab frame; a
/// cell is empty where nothing was measured or the fit does not reach.
[[nodiscard]] std::string fit_to_csv(const std::vector<ObjectFit>& fits);

}  // namespace kinectlab::commands
