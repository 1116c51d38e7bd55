#include "tests/bench/change_truth.hpp"

namespace kinectlab::bench {

ChangeCounts judge_change(const LabScene& before, const LabScene& now, const Mask& mask) {
    ChangeCounts counts;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (now.exact.z[i] > before.exact.z[i] + 0.02F) continue;
        const bool truly = now.exact.z[i] < before.exact.z[i] - 0.02F && now.seen.valid(i) &&
                           now.seen.z[i] < 0.5F * (now.exact.z[i] + before.exact.z[i]);
        counts.right += truly && mask[i] != 0 ? 1.0 : 0.0;
        counts.wrong += !truly && mask[i] != 0 ? 1.0 : 0.0;
        counts.missed += truly && mask[i] == 0 ? 1.0 : 0.0;
    }
    return counts;
}

Mask mask_of(const std::vector<ChangedRun>& runs, const ChangeSettings& settings) {
    Mask mask(static_cast<std::size_t>(settings.width * settings.height), 0);
    for (const auto& run : runs)
        for (int u = run.begin; u < run.end; ++u)
            mask[static_cast<std::size_t>(run.row * settings.width + u)] = 1;
    return mask;
}

}  // namespace kinectlab::bench
