#pragma once

#include <filesystem>

#include "pipeline/core/time.hpp"
#include "server/experiments/definition.hpp"

namespace kinectlab::experiments {

/// The values for an analysis: those given, then those that experiment.json in the recording's
/// folder tells ({"experiment", "parameters"}, as `simulate` writes it), then the defaults. What
/// only a simulation can set is not handed to an analysis. A file of another experiment is an
/// error.
[[nodiscard]] Result<Values> with_recorded_settings(
    const Definition& definition, const Values& given, const std::filesystem::path& recording
);

/// What only a simulation can set, as the same file tells it: no part of an analysis, but a
/// warning may want to know. Empty where there is no such file or it makes no sense.
[[nodiscard]] Values recorded_truth(
    const Definition& definition, const std::filesystem::path& recording
);

/// When everything was let go, from the recording's experiment.json; none where nothing says so.
[[nodiscard]] std::optional<TimeNs> recorded_release(const std::filesystem::path& recording);

}  // namespace kinectlab::experiments
