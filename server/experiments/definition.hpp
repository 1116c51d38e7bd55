#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/core/error.hpp"
#include "pipeline/run/tracking_plan.hpp"

namespace kinectlab::experiments {

/// One number that a person may set before a run.
struct Parameter {
    std::string name;  ///< with its unit at the end, e.g. "length_m"
    std::string unit;  ///< for people, e.g. "m"; "1" for a pure number
    double min = 0.0;
    double max = 0.0;
    double step = 0.0;                    ///< of the input field; values between the steps are fine
    std::optional<double> default_value;  ///< none: not given unless somebody gives it
    /// What a simulated rig has instead of default_value; of a real thing it would be a guess.
    std::optional<double> simulated_default;
    std::string help;              ///< one sentence for a student
    bool simulation_only = false;  ///< only a simulated rig can change it
};

/// An object of the experiment as in its definition: the JSON of one element of a list of objects,
/// in which {"parameter": NAME} stands for the run's value of that parameter.
struct ExperimentObject {
    std::string json;
};

/// A number of a definition: written out, or the run's value of a parameter.
struct Setting {
    std::optional<std::string> parameter;
    double number = 0.0;
};

/// What is done, in this order, before somebody may release.
struct SequenceStep {
    enum class Kind : std::uint8_t {
        stop,      ///< at rest, or parked where the apparatus parks
        clear,     ///< aside, so that all of the scene behind is seen once
        displace,  ///< to where it is released from
        wait,
    };
    Kind kind = Kind::stop;
    Setting to;  ///< of displace: in the parameter's unit; the actuator gets degrees as radians
    double seconds = 0.0;  ///< of wait
    bool learn = false;    ///< what is seen meanwhile belongs to the scene without objects
};

/// What ends a run before its duration is over.
struct EarlyEnd {
    std::optional<double> lost_s;   ///< no object was seen for so long after one was
    std::optional<double> still_s;  ///< every object stayed within 5 mm for so long
};

/// One setting of the analysis: a number, or what the run itself shows of another object.
struct AnalysisSource {
    Setting setting;
    std::optional<std::string> tilt_of;    ///< the angle of this object's plane to the level, °
    std::optional<std::string> tilt_u_of;  ///< its standard uncertainty, °
};

/// How the run becomes numbers: one of analysis_methods().
struct AnalysisChoice {
    std::string method;
    std::vector<std::string> objects;  ///< in the order in which the method takes them
    std::map<std::string, AnalysisSource> settings;
};

/// What a good run looks like, on a fact of the analysis, one of its results or one of
/// kCommonFacts.
struct AcceptanceCheck {
    std::string fact;
    std::optional<double> min;
    std::optional<double> max;
    std::string reason;  ///< for a student, if it is missed: what it means and what to do
};

/// What every run tells of itself besides its analysis' own facts.
inline constexpr std::array<std::string_view, 4> kCommonFacts{
    "duration_s", "tracked_share", "outlier_share", "reduced_chi2"};

/// What an experiment is, from NAME.json in this folder or as an instructor published it.
struct Definition {
    std::string id;
    std::string title;
    std::string summary;    ///< one or two plain sentences
    std::string theory;     ///< text for students, see student_text.hpp
    std::string apparatus;  ///< what a rig must have to do it
    std::vector<Parameter> parameters;
    std::vector<ExperimentObject> objects;
    std::optional<PreprocessSettings> preprocess;  ///< by default as PreprocessSettings
    std::vector<SequenceStep> sequence;
    Setting duration;  ///< s
    EarlyEnd early_end;
    AnalysisChoice analysis;
    std::vector<std::string> plots;  ///< names of the analysis' plots, in the order to show them
    std::vector<AcceptanceCheck> acceptance;
};

using Values = std::map<std::string, double>;

/// What kind of rig the values are for; parameters that only a simulation has are refused for a
/// real one, and left out of its values.
enum class RigKind { simulated, real, elsewhere };

/// The values of all parameters: those given, the others by default, a simulated rig's own first.
/// Errors name the parameter:
/// unknown (with the nearest valid name), out of range, NaN, or not to be set on a real rig. What
/// moved elsewhere is not bound to a rig's ranges: what cannot be negative has any value from 0;
/// nor has it a rig's defaults, but for what the analysis cannot do without.
[[nodiscard]] Result<Values> validate(
    const Definition& definition, const Values& given, RigKind rig = RigKind::simulated
);

/// The setting's value, in its parameter's unit; none where that parameter was not given.
[[nodiscard]] std::optional<double> value_of(const Setting& setting, const Values& values);

/// What to track in a run with these (validated) values.
[[nodiscard]] TrackingPlan plan_for(const Definition& definition, const Values& values);

/// Errors with the JSON path: unknown and missing keys, ranges without their default inside, units
/// that do not fit the names, objects and settings that the analysis does not take, text that could
/// carry more than text.
[[nodiscard]] Result<Definition> read_definition(const nlohmann::json& document);
/// The same for what comes from outside: held against the schema too.
[[nodiscard]] Result<Definition> read_with_schema(const nlohmann::json& document);
[[nodiscard]] nlohmann::json to_json(const Definition& definition);

/// All *.json of a folder by id. Errors name the file.
[[nodiscard]] Result<std::vector<Definition>> load_definitions(const std::filesystem::path& folder);

/// `folder`/`id`.json; an unknown id is refused with the nearest known one.
[[nodiscard]] Result<Definition> load_definition(
    const std::filesystem::path& folder, const std::string& id
);

}  // namespace kinectlab::experiments
