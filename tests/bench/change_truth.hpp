#pragma once

#include <vector>

#include "pipeline/preprocess/change.hpp"
#include "tests/bench/lab_scene.hpp"
#include "tests/bench/peer_preprocess.hpp"

namespace kinectlab::bench {

/// Pixels of a mask against the truth.
struct ChangeCounts {
    double right = 0.0, wrong = 0.0, missed = 0.0;
    [[nodiscard]] double f1() const { return 2.0 * right / (2.0 * right + wrong + missed); }
};

/// What truly changed: readings on the bob where it came. Where it stood in the reference the room
/// behind it is new to every method and counts for none.
[[nodiscard]] ChangeCounts judge_change(
    const LabScene& before, const LabScene& now, const Mask& mask
);

[[nodiscard]] Mask mask_of(const std::vector<ChangedRun>& runs, const ChangeSettings& settings);

}  // namespace kinectlab::bench
