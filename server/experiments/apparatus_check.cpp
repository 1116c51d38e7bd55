#include "server/experiments/apparatus_check.hpp"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/simulate/apparatus.hpp"
#include "server/experiments/definition_names.hpp"

namespace kinectlab::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::size_t place_of(const Definition& definition, const std::string& parameter) {
    const auto& all = definition.parameters;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == parameter; });
    return static_cast<std::size_t>(found - all.begin());
}

/// The apparatus' own error, where the definition can be mended.
Error in_definition(const Definition& definition, Error error) {
    const std::size_t i = place_of(definition, error.field);
    if (i < definition.parameters.size()) error.field = element_of("parameters", i) + ".default";
    return error;
}

/// What the step can displace to, in the parameter's unit.
std::vector<double> ends_of(const Definition& definition, const SequenceStep& step) {
    if (!step.to.parameter) return {step.to.number};
    const Parameter& p = definition.parameters[place_of(definition, *step.to.parameter)];
    return {p.min, p.max};
}

}  // namespace

Result<void> check_apparatus(const Definition& definition) {
    const auto names = simulate::apparatus_names();
    if (!among(names, definition.apparatus))
        return not_among("apparatus", definition.apparatus, names);
    const auto values = validate(definition, {}, RigKind::simulated);
    if (!values) return tl::unexpected(values.error());
    const auto settings = simulate::settings_for(definition.apparatus, *values);
    if (!settings) return tl::unexpected(settings.error());
    const auto apparatus = simulate::make_apparatus(*settings);
    if (!apparatus) return tl::unexpected(in_definition(definition, apparatus.error()));
    for (std::size_t i = 0; i < definition.sequence.size(); ++i) {
        const SequenceStep& step = definition.sequence[i];
        if (step.kind != SequenceStep::Kind::displace) continue;
        const bool degrees = step.to.parameter && step.to.parameter->ends_with("_deg");
        for (const double end : ends_of(definition, step)) {
            const double value = degrees ? end * kDegree : end;
            const auto ok = (*apparatus)->apply({simulate::Action::displace, value});
            if (ok) continue;
            return fail(
                ErrorCode::invalid_argument,
                element_of("sequence", i) + ".to",
                fmt::format(
                    "can be {:.6g}{}, and the {} does not reach so far",
                    end,
                    degrees ? "°" : "",
                    definition.apparatus
                ),
                ok.error().cure + (step.to.parameter ? ": narrow the range of " + *step.to.parameter
                                                     : std::string())
            );
        }
    }
    return {};
}

}  // namespace kinectlab::experiments
