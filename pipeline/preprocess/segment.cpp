#include "pipeline/preprocess/segment.hpp"

#include <algorithm>
#include <numeric>

namespace kinectlab {

Segmenter::Segmenter(const ChangeSettings& settings, int min_points)
    : settings_(settings), min_points_(min_points) {
    const std::size_t runs = most_runs(settings);
    parent_.reserve(runs);
    component_of_.reserve(runs);
    components_.reserve(runs);
    pixels_.reserve(
        static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height)
    );
    segments_.reserve(kMaxSegments);
}

std::span<const PixelList> Segmenter::segment(
    std::span<const std::uint16_t> depth,
    std::span<const std::uint8_t> trusted,
    std::span<const ChangedRun> runs
) {
    connect(depth, runs);
    measure(trusted, runs);
    emit(runs);
    return segments_;
}

/// Union-find over the runs; two rows are walked side by side.
void Segmenter::connect(std::span<const std::uint16_t> depth, std::span<const ChangedRun> runs) {
    parent_.resize(runs.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    std::size_t above = 0;
    for (std::size_t below = 0; below < runs.size(); ++below) {
        const ChangedRun& run = runs[below];
        while (runs[above].row < run.row - 1 ||
               (runs[above].row == run.row - 1 && runs[above].end < run.begin))
            ++above;
        for (std::size_t k = above; k < below; ++k) {
            if (runs[k].row != run.row - 1 || runs[k].begin > run.end) break;
            if (touches(depth, runs[k], run))
                parent_[static_cast<std::size_t>(root_of(static_cast<std::int32_t>(below)))] =
                    root_of(static_cast<std::int32_t>(k));
        }
    }
}

/// Corners touch as well; the depths are compared in the middle of the common columns.
bool Segmenter::touches(
    std::span<const std::uint16_t> depth, const ChangedRun& above, const ChangedRun& below
) const {
    const int common = (std::max(above.begin, below.begin) + std::min(above.end, below.end)) / 2;
    const auto at = [&](const ChangedRun& run) {
        const int column = std::clamp(common, run.begin, run.end - 1);
        return depth[static_cast<std::size_t>(run.row * settings_.width + column)];
    };
    return continuous(settings_, at(above), at(below));
}

std::int32_t Segmenter::root_of(std::int32_t run) {
    auto& parent = parent_;
    const auto up = [&parent](std::int32_t i) -> std::int32_t& {
        return parent[static_cast<std::size_t>(i)];
    };
    while (up(run) != run) {
        up(run) = up(up(run));
        run = up(run);
    }
    return run;
}

void Segmenter::measure(std::span<const std::uint8_t> trusted, std::span<const ChangedRun> runs) {
    components_.clear();
    component_of_.assign(runs.size(), -1);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::int32_t root = root_of(static_cast<std::int32_t>(i));
        std::int32_t& component = component_of_[static_cast<std::size_t>(root)];
        if (component < 0) {
            component = static_cast<std::int32_t>(components_.size());
            components_.push_back({root, 0, 0, runs[i].row, runs[i].row});
        }
        Component& whole = components_[static_cast<std::size_t>(component)];
        whole.points += runs[i].end - runs[i].begin;
        const auto first = trusted.begin() + runs[i].row * settings_.width;
        whole.trusted += std::accumulate(first + runs[i].begin, first + runs[i].end, 0);
        whole.last_row = runs[i].row;
    }
    std::erase_if(components_, [this](const Component& c) {
        return c.trusted < min_points_ || c.last_row - c.first_row + 1 < settings_.min_run;
    });
    std::sort(components_.begin(), components_.end(), [](const Component& a, const Component& b) {
        return a.points != b.points ? a.points > b.points : a.root < b.root;
    });
    if (components_.size() > kMaxSegments) components_.resize(kMaxSegments);
}

void Segmenter::emit(std::span<const ChangedRun> runs) {
    // Each component's place in pixels_ first, then its runs in reading order.
    std::fill(component_of_.begin(), component_of_.end(), -1);
    std::int32_t total = 0;
    for (auto& component : components_) {
        component_of_[static_cast<std::size_t>(component.root)] = total;
        total += component.points;
    }
    pixels_.resize(static_cast<std::size_t>(total));
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto root = static_cast<std::size_t>(root_of(static_cast<std::int32_t>(i)));
        std::int32_t& place = component_of_[root];
        if (place < 0) continue;
        const auto length = runs[i].end - runs[i].begin;
        const auto first = pixels_.begin() + place;
        const int index = runs[i].row * settings_.width + runs[i].begin;
        std::iota(first, first + length, static_cast<std::uint32_t>(index));
        place += length;
    }
    segments_.clear();
    std::size_t first = 0;
    for (const auto& component : components_) {
        segments_.emplace_back(pixels_.data() + first, static_cast<std::size_t>(component.points));
        first += static_cast<std::size_t>(component.points);
    }
}

}  // namespace kinectlab
