#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/motion/motion.hpp"
#include "server/experiments/definition.hpp"
#include "server/experiments/evaluate.hpp"

namespace kinectlab::commands {

/// Makes `folder` if need be and writes result.json, poses.csv, fit.csv, plots.json, each plot and
/// the budget as NAME.svg and NAME.png, and report.html, a page to print. `trajectories`: all that
/// was tracked, in the lab frame.
[[nodiscard]] Result<void> write_analysis(
    const std::filesystem::path& folder,
    const experiments::Definition& definition,
    const experiments::Evaluation& evaluation,
    const std::vector<Trajectory>& trajectories
);

}  // namespace kinectlab::commands
