#pragma once

#include "pipeline/core/error.hpp"
#include "server/experiments/definition.hpp"

namespace kinectlab::experiments {

/// Sets up the definition's apparatus as the simulated rig has it, its parameters as usual, and
/// displaces it to wherever the sequence can, at both ends of the parameter's range. Errors: an
/// apparatus that is not known (`apparatus`, with the nearest), parameters that it does not take
/// (`parameters[i]`), a displacement out of its reach (`sequence[i].to`).
[[nodiscard]] Result<void> check_apparatus(const Definition& definition);

}  // namespace kinectlab::experiments
