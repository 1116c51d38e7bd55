#include "server/rig/preparation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace kinectlab::rig {

double clear_angle(double length_m, double bob_radius_m) {
    constexpr double kLargest = std::numbers::pi / 6.0;
    constexpr double kRadiiAside = 2.5;
    return std::min(std::asin(std::min(kRadiiAside * bob_radius_m / length_m, 1.0)), kLargest);
}

Preparation::Preparation(Actuator& actuator, const PreparationSettings& settings)
    : actuator_(actuator), settings_(settings) {}

Result<Preparation::Progress> Preparation::step(TimeNs now) {
    Progress progress;
    switch (stage_) {
        case Stage::begin: {
            if (auto sent = actuator_.stop(); !sent) return tl::unexpected(sent.error());
            wanted_ = BobMotion::at_rest;
            enter(Stage::stopping, now);
            break;
        }
        case Stage::stopping: {
            const auto there = arrived(now);
            if (!there) return tl::unexpected(there.error());
            if (*there) enter(Stage::learning_at_rest, now);
            break;
        }
        case Stage::learning_at_rest: {
            progress.learn = true;
            if (now - since_ < settings_.learn) break;
            const double aside = std::max(settings_.amplitude_rad, settings_.clear_angle_rad);
            if (auto sent = move_to(aside, Stage::clearing, now); !sent) {
                return tl::unexpected(sent.error());
            }
            break;
        }
        case Stage::clearing: {
            progress.learn = true;
            const auto there = arrived(now);
            if (!there) return tl::unexpected(there.error());
            if (*there) enter(Stage::learning_aside, now);
            break;
        }
        case Stage::learning_aside: {
            progress.learn = true;
            if (now - since_ < settings_.learn) break;
            if (settings_.amplitude_rad >= settings_.clear_angle_rad) {
                enter(Stage::settling, now);
            } else if (auto sent = move_to(settings_.amplitude_rad, Stage::displacing, now);
                       !sent) {
                return tl::unexpected(sent.error());
            }
            break;
        }
        case Stage::displacing: {
            const auto there = arrived(now);
            if (!there) return tl::unexpected(there.error());
            if (*there) enter(Stage::settling, now);
            break;
        }
        case Stage::settling:
            if (now - since_ >= settings_.settle) enter(Stage::done, now);
            break;
        case Stage::done:
            break;
    }
    progress.done = stage_ == Stage::done;
    return progress;
}

Result<void> Preparation::move_to(double angle_rad, Stage stage, TimeNs now) {
    wanted_ = BobMotion::held;
    wanted_angle_ = angle_rad;
    enter(stage, now);
    return actuator_.displace(angle_rad);
}

Result<bool> Preparation::arrived(TimeNs now) {
    const auto state = actuator_.state();
    if (!state) return tl::unexpected(state.error());
    const bool right_angle =
        wanted_ != BobMotion::held ||
        std::abs(state->angle_rad - wanted_angle_) <= settings_.angle_tolerance_rad;
    if (state->motion == wanted_ && right_angle) return true;
    if (now - since_ <= settings_.step_limit) return false;
    const std::string told =
        wanted_ == BobMotion::held
            ? fmt::format("hold the bob at {:.1f}°", wanted_angle_ * 180.0 / std::numbers::pi)
            : "bring the bob to rest";
    return fail(
        ErrorCode::unavailable,
        "actuator",
        fmt::format(
            "was told to {} and did not within {:.0f} s", told, to_seconds(settings_.step_limit)
        )
    );
}

void Preparation::enter(Stage stage, TimeNs now) {
    stage_ = stage;
    since_ = now;
}

}  // namespace kinectlab::rig
