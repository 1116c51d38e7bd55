#include "pipeline/preprocess/moving_least_squares_settings.hpp"

#include <cmath>

#include "pipeline/core/number_text.hpp"

namespace kinectlab {

Result<void> check(const MovingLeastSquaresSettings& settings) {
    const auto wrong = [](const char* field, double value, const char* cure) {
        return fail(ErrorCode::invalid_argument, field, "is " + number_text(value), cure);
    };
    const auto positive = [](double value) {
        return std::isfinite(value) && value > 0.0;
    };
    if (!positive(settings.radius_m))
        return wrong("radius_m", settings.radius_m, "give metres above 0, such as 0.02");
    if (!positive(settings.epsilon_m))
        return wrong("epsilon_m", settings.epsilon_m, "give metres above 0, such as the radius");
    if (!std::isfinite(settings.depth_noise_per_m) || settings.depth_noise_per_m < 0.0)
        return wrong(
            "depth_noise_per_m", settings.depth_noise_per_m, "give 0 or more, such as 0.001645"
        );
    return {};
}

}  // namespace kinectlab
