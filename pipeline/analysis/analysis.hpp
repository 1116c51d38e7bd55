#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/analysis/plot.hpp"
#include "pipeline/core/error.hpp"
#include "pipeline/core/measurement.hpp"
#include "pipeline/core/trajectory.hpp"

namespace kinectlab {

/// A number that an analysis can be told.
struct AnalysisSetting {
    std::string name;  ///< with its unit at the end: "length_m"
    double min = 0.0;
    double max = 0.0;
    /// What holds where it is not given; none: it is then estimated, or its effect is a line in
    /// the budget, as `help` says.
    std::optional<double> otherwise;
    std::string help;
    /// Without it nothing can be measured. Never together with `otherwise`.
    bool required = false;
};

using AnalysisSettings = std::map<std::string, double>;

/// What the numbers rest on besides the positions.
struct AnalysisConditions {
    double depth_scale_u = 1e-3;  ///< relative standard uncertainty of every length that is seen
    double clock_u = 2e-5;        ///< relative, of the clock's rate
    double tilt_u_rad = 0.02;     ///< how well the lab frame's z is up, about each horizontal axis
    bool on_earth = true;         ///< false where a simulation took another g on purpose
    bool metric = true;           ///< false: positions are in pixels, of unknown size
    std::optional<TimeNs> released{};  ///< by the trajectories' clock; none: not known
    double released_u_s = 0.002;       ///< how well that moment is known
};

/// One object's measured and fitted motion at its samples' times, for plots and tables.
struct ObjectFit {
    std::string object;
    std::vector<TimeNs> t;
    std::vector<Eigen::Vector3d> p_lab;     ///< m; NaN where the sample was not measured
    std::vector<Eigen::Vector3d> fit_lab;   ///< m; NaN where the model does not reach
    std::vector<Eigen::Vector3d> residual;  ///< measured minus fitted, m
    int used = 0;                           ///< samples that the fit rests on
    int outliers = 0;                       ///< samples weighted down to next to nothing
    double reduced_chi2 = 0.0;              ///< of the used ones, against the tracker's covariances
};

/// What a run came to.
struct AnalysisOutcome {
    std::vector<Measurement> measurements;
    std::vector<ObjectFit> fits;          ///< in the order of the objects
    std::vector<Plot> plots;              ///< all that the method promises and the data allow
    std::map<std::string, double> facts;  ///< what acceptance checks look at: "periods"
    std::vector<std::string> warnings;    ///< for a student: what makes this run less good
    std::vector<std::string> notes;       ///< what was assumed or estimated, and what that costs
};

/// One way to make results of motion. One .cpp for each, listed in analysis_methods().
struct AnalysisMethod {
    std::string name;  ///< by which a definition chooses it
    int objects = 1;   ///< trajectories that it takes, in the order of the definition
    bool needs_orientation = false;
    std::vector<AnalysisSetting> settings;
    std::vector<std::string> results;  ///< names of measurements that it may give
    std::vector<std::string> plots;
    std::vector<std::string> facts;
    /// The settings have been checked, defaults filled in; there are `objects` trajectories.
    /// Errors are refusals with a reason for a student, never a number.
    Result<AnalysisOutcome> (*run
    )(std::span<const Trajectory> objects,
      const AnalysisSettings& settings,
      const AnalysisConditions& conditions) = nullptr;
};

/// All of them, in the order in which they are listed to people.
[[nodiscard]] const std::vector<AnalysisMethod>& analysis_methods();

/// Errors: not_found with the nearest name.
[[nodiscard]] Result<const AnalysisMethod*> analysis_method(const std::string& name);

/// Unknown names (with the nearest one), values out of range or not finite, required ones that are
/// missing: errors that name the setting. Returns the settings with what holds otherwise.
[[nodiscard]] Result<AnalysisSettings> check_settings(
    const AnalysisMethod& method, const AnalysisSettings& given
);

/// check_settings, the number of objects and their orientation, then the method itself.
[[nodiscard]] Result<AnalysisOutcome> analyse(
    const std::string& method,
    std::span<const Trajectory> objects,
    const AnalysisSettings& settings,
    const AnalysisConditions& conditions
);

}  // namespace kinectlab
