#include "pipeline/preprocess/change.hpp"

#include <algorithm>
#include <array>

#include "pipeline/core/hot_loop.hpp"

namespace kinectlab {
namespace {

constexpr int kBlock = 64;  // pixels looked at together; nearly all blocks hold no change

bool changed(std::uint16_t depth, std::uint16_t reach) {
    return static_cast<std::uint16_t>(depth - 1) < reach;
}

/// One byte a block of a whole picture: does any pixel in it change?
KINECTLAB_HOT_LOOP void mark_blocks(
    const std::uint16_t* __restrict depth,
    const std::uint16_t* __restrict reach,
    int blocks,
    std::uint8_t* __restrict any
) {
    for (int block = 0; block < blocks; ++block) {
        std::uint16_t found = 0;
        for (int i = 0; i < kBlock; ++i) {
            const auto counts = static_cast<std::uint16_t>(depth[i] - 1);
            found = static_cast<std::uint16_t>(found | (counts < reach[i] ? 1 : 0));
        }
        any[block] = static_cast<std::uint8_t>(found);
        depth += kBlock;
        reach += kBlock;
    }
}

/// The runs among columns [begin, end) of one row; an open run goes on from block to block.
class RunCollector {
public:
    RunCollector(const ChangeSettings& settings, std::vector<ChangedRun>& runs)
        : settings_(settings), runs_(runs) {}

    void add(int row, int column, std::uint16_t depth) {
        const bool goes_on =
            row == open_.row && column == open_.end && continuous(settings_, last_depth_, depth);
        if (!goes_on) {
            close();
            open_ = {row, column, column};
        }
        ++open_.end;
        last_depth_ = depth;
    }
    void close() {
        if (open_.end - open_.begin >= settings_.min_run) runs_.push_back(open_);
        open_ = {-1, 0, 0};
    }

private:
    const ChangeSettings& settings_;
    std::vector<ChangedRun>& runs_;
    ChangedRun open_{-1, 0, 0};
    std::uint16_t last_depth_ = 0;
};

}  // namespace

std::size_t most_runs(const ChangeSettings& settings) {
    return static_cast<std::size_t>(settings.height) *
           static_cast<std::size_t>(settings.width / std::max(1, settings.min_run) + 1);
}

void find_changed(
    std::span<const std::uint16_t> depth,
    std::span<const std::uint16_t> reach,
    const ChangeSettings& settings,
    std::vector<ChangedRun>& runs
) {
    runs.clear();
    RunCollector collector(settings, runs);
    constexpr int kBatch = 128;
    std::array<std::uint8_t, kBatch> any{};
    const int pixels = static_cast<int>(depth.size());
    const auto scan = [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (changed(depth[at], reach[at]))
                collector.add(i / settings.width, i % settings.width, depth[at]);
        }
    };
    const int blocks = pixels / kBlock;
    for (int batch = 0; batch < blocks; batch += kBatch) {
        const int count = std::min(kBatch, blocks - batch);
        const auto offset = static_cast<std::size_t>(batch) * kBlock;
        mark_blocks(depth.data() + offset, reach.data() + offset, count, any.data());
        for (int k = 0; k < count; ++k)
            if (any[static_cast<std::size_t>(k)] != 0)
                scan((batch + k) * kBlock, (batch + k + 1) * kBlock);
    }
    scan(blocks * kBlock, pixels);
    collector.close();
}

}  // namespace kinectlab
