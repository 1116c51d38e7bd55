// What a person may ask of the colour method.
#include <string>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/colour.hpp"
#include "pipeline/track/picture_box.hpp"

namespace kinectlab {
namespace {

Result<void> check_range(
    double low, double high, double most, const std::string& field, bool may_wrap
) {
    const bool fits = low >= 0.0 && high >= 0.0 && low <= most && high <= most;  // not of NaN
    if (fits && (low < high || (may_wrap && low != high))) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is [" + number_text(low) + ", " + number_text(high) + "]",
        std::string("give [lowest, highest] from 0 to ") + (most > 1.0 ? "360" : "1") +
            (may_wrap ? "; lowest > highest goes through red" : "")
    );
}

}  // namespace

Result<void> check(
    const ColourSettings& settings, const RgbdCamera& camera, const std::string& path
) {
    if (settings.bounds.has_value() == settings.box.has_value())
        return fail(
            ErrorCode::invalid_argument,
            path,
            settings.box ? "has both a place to learn the colour from and bounds"
                         : "has neither bounds nor a place to learn the colour from",
            "give hue_deg, or click or box"
        );
    if (auto ok = check_learn_at(settings.learn_at_s, path + ".learn_at_s"); !ok) return ok;
    if (settings.box) return check_box(*settings.box, camera.colour, path + ".box");
    const ColourBounds& b = *settings.bounds;
    if (auto ok = check_range(b.hue_min_deg, b.hue_max_deg, 360.0, path + ".hue_deg", true); !ok)
        return ok;
    if (auto ok = check_range(b.saturation_min, b.saturation_max, 1.0, path + ".saturation", false);
        !ok)
        return ok;
    return check_range(b.value_min, b.value_max, 1.0, path + ".value", false);
}

}  // namespace kinectlab
