#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/track/object_spec.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {

/// A document's objects name their models from where the document's own file is: each "model" that
/// is a relative path becomes one from `file`'s folder. Anything of another shape stays as it is.
[[nodiscard]] nlohmann::json with_models_beside(
    const std::filesystem::path& file, nlohmann::json document
);

/// Method "surface_patch": {"model": FILE, "model_unit_m": 1, "seed": 1}. The file is read here,
/// because the pipeline's methods take values; what is wrong with it is told through the reader.
[[nodiscard]] MethodSettings read_surface_patch(ObjectReader& reader);

/// What a person should know of the objects' models, such as sizes that look like millimetres.
[[nodiscard]] std::vector<std::string> warnings_of(const std::vector<ObjectSpec>& objects);

}  // namespace kinectlab::experiments
