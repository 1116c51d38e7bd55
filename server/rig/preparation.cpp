#include "server/rig/preparation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace kinectlab::rig {
namespace {

using Kind = experiments::SequenceStep::Kind;

}  // namespace

double clear_angle(double length_m, double bob_radius_m) {
    constexpr double kLargest = std::numbers::pi / 6.0;
    constexpr double kRadiiAside = 2.5;
    return std::min(std::asin(std::min(kRadiiAside * bob_radius_m / length_m, 1.0)), kLargest);
}

PreparationSettings preparation_for(
    const experiments::Definition& definition, const experiments::Values& values
) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    const auto value = [&](const char* name, double otherwise) {
        const auto found = values.find(name);
        return found == values.end() ? otherwise : found->second;
    };
    PreparationSettings settings;
    for (const auto& step : definition.sequence) {
        PreparationStep made;
        made.kind = step.kind;
        made.seconds = step.seconds;
        made.learn = step.learn;
        if (step.kind == Kind::displace) {
            const std::string name = step.to.parameter.value_or("");
            made.in_degrees = name.size() > 4 && name.compare(name.size() - 4, 4, "_deg") == 0;
            made.value = experiments::value_of(step.to, values).value_or(0.0) *
                         (made.in_degrees ? kDegree : 1.0);
        } else if (step.kind == Kind::clear) {
            made.in_degrees = true;
            made.value = clear_angle(value("length_m", 1.0), value("bob_radius_m", 0.05));
        }
        settings.steps.push_back(made);
    }
    return settings;
}

Preparation::Preparation(Actuator& actuator, PreparationSettings settings)
    : actuator_(actuator), settings_(std::move(settings)) {}

Result<Preparation::Progress> Preparation::step(TimeNs now) {
    while (at_ < settings_.steps.size()) {
        const PreparationStep& step = settings_.steps[at_];
        if (!begun_) {
            since_ = now;
            begun_ = true;
            if (auto sent = begin(step); !sent) return tl::unexpected(sent.error());
            return Progress{step.learn, false};
        }
        const auto there = over(step, now);
        if (!there) return tl::unexpected(there.error());
        if (!*there) return Progress{step.learn, false};
        ++at_;
        begun_ = false;
    }
    return Progress{false, true};
}

Result<void> Preparation::begin(const PreparationStep& step) {
    switch (step.kind) {
        case Kind::stop:
            return actuator_.stop();
        case Kind::clear:
        case Kind::displace:
            return actuator_.displace(step.value);
        case Kind::wait:
            return {};
    }
    return {};
}

Result<bool> Preparation::over(const PreparationStep& step, TimeNs now) {
    if (step.kind == Kind::wait) return to_seconds(now - since_) >= step.seconds;
    const auto state = actuator_.state();
    if (!state) return tl::unexpected(state.error());
    const bool stops = step.kind == Kind::stop;
    const bool there = stops ? state->motion == ApparatusMotion::at_rest
                             : state->motion == ApparatusMotion::held &&
                                   std::abs(state->value - step.value) <= settings_.tolerance;
    if (there) return true;
    if (now - since_ <= settings_.step_limit) return false;
    const std::string told =
        stops ? "bring everything to rest"
        : step.in_degrees
            ? fmt::format("hold the bob at {:.1f}°", step.value * 180.0 / std::numbers::pi)
            : fmt::format("hold the object at {:.3f} m", step.value);
    return fail(
        ErrorCode::unavailable,
        "actuator",
        fmt::format(
            "was told to {} and did not within {:.0f} s", told, to_seconds(settings_.step_limit)
        )
    );
}

}  // namespace kinectlab::rig
