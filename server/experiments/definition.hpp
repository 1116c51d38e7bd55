#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
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
    double step = 0.0;  ///< of the input field; values between the steps are fine
    double default_value = 0.0;
    std::string help;              ///< one sentence for a student
    bool simulation_only = false;  ///< only a simulated rig can change it
};

/// An object of the experiment as in its definition: the JSON of one element of a list of objects,
/// in which {"parameter": NAME} stands for the run's value of that parameter.
struct ExperimentObject {
    std::string json;
};

/// What an experiment is, from NAME.json in this folder.
struct Definition {
    std::string id;
    std::string title;
    std::string summary;
    std::vector<Parameter> parameters;
    std::vector<ExperimentObject> objects;
    std::optional<PreprocessSettings> preprocess;  ///< by default as PreprocessSettings
};

using Values = std::map<std::string, double>;

/// What kind of rig the values are for; parameters that only a simulation has are refused for a
/// real one, and left out of its values.
enum class RigKind { simulated, real, elsewhere };

/// The values of all parameters: those given, the others by default. Errors name the parameter:
/// unknown (with the nearest valid name), out of range, NaN, or not to be set on a real rig. What
/// moved elsewhere is not bound to a rig's ranges: what cannot be negative has any value from 0.
[[nodiscard]] Result<Values> validate(
    const Definition& definition, const Values& given, RigKind rig = RigKind::simulated
);

/// What to track in a run with these (validated) values.
[[nodiscard]] TrackingPlan plan_for(const Definition& definition, const Values& values);

/// Unknown keys, missing keys, ranges without their default inside: errors with the JSON path.
[[nodiscard]] Result<Definition> read_definition(const nlohmann::json& document);
[[nodiscard]] nlohmann::json to_json(const Definition& definition);

/// All *.json of a folder by id. Errors name the file.
[[nodiscard]] Result<std::vector<Definition>> load_definitions(const std::filesystem::path& folder);

/// `folder`/`id`.json; an unknown id is refused with the nearest known one.
[[nodiscard]] Result<Definition> load_definition(
    const std::filesystem::path& folder, const std::string& id
);

}  // namespace kinectlab::experiments
