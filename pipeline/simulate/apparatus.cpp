#include "pipeline/simulate/apparatus.hpp"

#include <algorithm>
#include <array>

#include "pipeline/core/nearest_name.hpp"
#include "pipeline/simulate/actuated_pendulum.hpp"
#include "pipeline/simulate/collision.hpp"
#include "pipeline/simulate/incline.hpp"
#include "pipeline/simulate/projectile.hpp"
#include "pipeline/simulate/robot.hpp"
#include "pipeline/simulate/spring.hpp"
#include "pipeline/simulate/tumbler.hpp"

namespace kinectlab::simulate {
namespace {

Result<std::unique_ptr<Apparatus>> make_pendulum(const ParameterMap& given) {
    const auto parameters = pendulum_parameters(given);
    if (!parameters) return tl::unexpected(parameters.error());
    return std::make_unique<ActuatedPendulum>(*parameters, pivot_of(parameters->length_m));
}

struct Kind {
    std::string_view name;
    std::span<const ParameterRange> (*ranges)();
    Result<std::unique_ptr<Apparatus>> (*make)(const ParameterMap& given);
};

constexpr std::array kKinds = {
    Kind{"pendulum", pendulum_ranges, make_pendulum},
    Kind{"projectile", projectile_ranges, make_projectile},
    Kind{"incline", incline_ranges, make_incline},
    Kind{"spring", spring_ranges, make_spring},
    Kind{"collision", collision_ranges, make_collision},
    Kind{"robot", robot_ranges, make_robot},
    Kind{"tumbler", tumbler_ranges, make_tumbler},
};

Result<const Kind*> kind_of(std::string_view name) {
    const auto found = std::find_if(kKinds.begin(), kKinds.end(), [name](const Kind& kind) {
        return kind.name == name;
    });
    if (found != kKinds.end()) return found;
    return fail(
        ErrorCode::not_found,
        "apparatus",
        "there is no \"" + std::string(name.substr(0, 60)) + "\"",
        did_you_mean(name, apparatus_names())
    );
}

}  // namespace

std::vector<std::string> apparatus_names() {
    std::vector<std::string> names;
    for (const Kind& kind : kKinds)
        names.emplace_back(kind.name);
    return names;
}

Result<std::span<const ParameterRange>> parameters_of(std::string_view apparatus) {
    return kind_of(apparatus).map([](const Kind* kind) { return kind->ranges(); });
}

Result<ApparatusSettings> settings_for(std::string_view apparatus, const ParameterMap& values) {
    const auto ranges = parameters_of(apparatus);
    if (!ranges) return tl::unexpected(ranges.error());
    ApparatusSettings settings{std::string(apparatus), {}};
    for (const ParameterRange& range : *ranges)
        if (const auto value = values.find(std::string(range.name)); value != values.end())
            settings.parameters.insert(*value);
    return settings;
}

Result<std::unique_ptr<Apparatus>> make_apparatus(const ApparatusSettings& settings) {
    return kind_of(settings.name).and_then([&settings](const Kind* kind) {
        return kind->make(settings.parameters);
    });
}

}  // namespace kinectlab::simulate
