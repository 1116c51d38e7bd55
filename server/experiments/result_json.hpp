#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/camera.hpp"
#include "pipeline/core/measurement.hpp"
#include "pipeline/core/time.hpp"

namespace kinectlab::experiments {

/// What a result rests on, so that it can be judged and made again.
struct Provenance {
    std::string program_version;
    std::string source;                ///< the recording, or the rig and run
    std::optional<RgbdCamera> camera;  ///< none of a table that another program wrote
    std::string units;                 ///< of such a table, as they were read; else empty
    std::optional<Eigen::Isometry3d> T_lab_cam;
    bool lab_frame_assumed = false;  ///< nothing said where the camera stands: taken to be level
    TimeNs first_frame = 0;
    TimeNs last_frame = 0;
    std::size_t frames = 0;
    std::size_t frames_tracked = 0;
    std::size_t samples_used = 0;  ///< by the fit
    std::size_t outliers = 0;
    double reduced_chi2 = 0.0;
};

/// {"name","value","u","unit","k":1,"budget":[{"source","u"}]}; u is the standard uncertainty.
[[nodiscard]] nlohmann::json to_json(const Measurement& measurement);

/// Both cameras, their transform, depth unit, noise and uncertainties.
[[nodiscard]] nlohmann::json to_json(const RgbdCamera& camera);

/// The project's result: {"experiment","parameters","results":[…],"warnings","provenance"}.
[[nodiscard]] nlohmann::json result_to_json(
    const std::string& experiment,
    const std::map<std::string, double>& parameters,
    const std::vector<Measurement>& results,
    const std::vector<std::string>& warnings,
    const Provenance& provenance
);

}  // namespace kinectlab::experiments
