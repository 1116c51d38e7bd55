#include "pipeline/track/picture_box.hpp"

#include <cmath>

#include "pipeline/core/number_text.hpp"

namespace kinectlab {

Result<void> check_box(const PictureBox& box, const Pinhole& picture, const std::string& field) {
    const auto text = "is " + std::to_string(box.width) + "x" + std::to_string(box.height) +
                      " px at (" + std::to_string(box.left) + ", " + std::to_string(box.top) + ")";
    const auto size = std::to_string(picture.width) + "x" + std::to_string(picture.height);
    if (box.width < 1 || box.height < 1)
        return fail(ErrorCode::invalid_argument, field, text, "give a width and height above 0");
    // Subtracted, not added: the sum of two large numbers may not fit.
    if (box.left < 0 || box.top < 0 || box.left > picture.width - box.width ||
        box.top > picture.height - box.height)
        return fail(
            ErrorCode::invalid_argument,
            field,
            text + ", not inside the colour picture",
            "give a place inside of " + size + " px"
        );
    return {};
}

Result<void> check_learn_at(double learn_at_s, const std::string& field) {
    if (learn_at_s >= 0.0 && learn_at_s <= 86'400.0) return {};
    return fail(
        ErrorCode::invalid_argument,
        field,
        "is " + number_text(learn_at_s),
        "give seconds after the first frame, 0 to 86400"
    );
}

}  // namespace kinectlab
