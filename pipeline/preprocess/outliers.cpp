#include "pipeline/preprocess/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipeline/preprocess/distance_kernels.hpp"
#include "pipeline/preprocess/pixel_window.hpp"
#include "pipeline/preprocess/point_tree.hpp"

namespace kinectlab {
namespace {

// The next point's K-th neighbour is about as far away: looking this much farther rarely fails.
constexpr float kHeadroom = 1.15F;

/// Searches a tree for the K nearest and keeps what it learns for the next point.
class TreeSearch {
public:
    TreeSearch(const Cloud& cloud, int k)
        : tree_(cloud), k_(k), most_(4 * k + PointTree::kLeafSize), found_(buffer_size(most_)) {}

    [[nodiscard]] const PointTree& tree() const { return tree_; }

    double sum_of_roots(Point3 from) {
        collect(from, last_);
        if (size_ < k_) collect(from, std::numeric_limits<float>::infinity());
        const Rank rank = rank_of(kernels_, found_.data(), size_, k_, limit_);
        last_ = rank.limit * kHeadroom;
        return sum_of_smallest_roots(kernels_, found_.data(), size_, k_, rank);
    }

private:
    static std::size_t buffer_size(int most) {
        return static_cast<std::size_t>(most + PointTree::kLeafSize + 16);
    }

    void collect(Point3 from, float limit) {
        size_ = 0;
        limit_ = limit;
        tree_.visit_within(from, limit_, [&](const PointTree::Leaf& leaf) {
            size_ += kernels_.collect(tree_.rows(leaf), from, limit_, found_.data() + size_);
            if (size_ > most_) keep_nearest();
        });
    }

    /// Forgets all but K; what is as far as the farthest of them cannot change the sum.
    void keep_nearest() {
        const Rank rank = rank_of(kernels_, found_.data(), size_, k_, limit_);
        const bool tied = rank.below != k_;
        const auto end = found_.begin() + size_;
        const auto kept = std::remove_if(found_.begin(), end, [&](float squared) {
            return tied ? squared >= rank.limit : squared > rank.limit;
        });
        std::fill(kept, found_.begin() + k_, rank.limit);
        size_ = k_;
        limit_ = tied ? rank.limit : std::nextafter(rank.limit, 1e30F);
    }

    const DistanceKernels& kernels_ = distance_kernels();
    PointTree tree_;
    int k_;
    int most_;
    std::vector<float> found_;
    int size_ = 0;
    float limit_ = 0.0F;
    float last_ = std::numeric_limits<float>::infinity();
};

/// Mean distances of one cloud, whichever way its neighbours are found.
class MeanDistances {
public:
    MeanDistances(const Cloud& cloud, int neighbours)
        : cloud_(cloud), k_(neighbours + 1), mean_(cloud.size(), 0.0F) {}

    std::vector<float> find() {
        if (const auto windows = PixelWindows::of(cloud_)) {
            search_windows(*windows);
        } else {
            search_tree();
        }
        return std::move(mean_);
    }

private:
    // K + 1 because a point is its own first neighbour, at distance 0.
    [[nodiscard]] float mean_of(double sum) const { return static_cast<float>(sum / (k_ - 1)); }

    TreeSearch& tree_search() {
        if (!tree_search_) tree_search_ = std::make_unique<TreeSearch>(cloud_, k_);
        return *tree_search_;
    }

    void search_tree() {
        TreeSearch& search = tree_search();
        const PointTree& tree = search.tree();
        for (const auto& leaf : tree.leaves())
            for (std::uint32_t place = leaf.begin; place < leaf.begin + leaf.count; ++place)
                mean_[tree.index(place)] = mean_of(search.sum_of_roots(tree.point(place)));
    }

    void search_windows(const PixelWindows& windows) {
        found_.resize(PixelWindows::kMostPoints + 16);
        float row_guess = 1e-4F;  // m², about K = 100 at 1 m; corrected at once
        for (int v = 0; v < cloud_.height; ++v) {
            float guess = row_guess;
            bool first = true;
            PixelWindow window{0, 0, v, v};
            int last_u = 0;
            for (int u = 0; u < cloud_.width; ++u) {
                const auto i =
                    static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud_.width) +
                    static_cast<std::size_t>(u);
                if (!cloud_.valid(i)) continue;
                window.left += u - last_u;
                window.right += u - last_u;
                last_u = u;
                const Point3 from{cloud_.x[i], cloud_.y[i], cloud_.z[i]};
                mean_[i] = mean_of(sum_in_window(windows, u, v, from, guess, window));
                if (first) row_guess = guess;
                first = false;
            }
        }
    }

    double sum_in_window(
        const PixelWindows& windows, int u, int v, Point3 from, float& guess, PixelWindow& window
    ) {
        for (float limit = guess;;) {
            if (!windows.fit(u, v, from, std::sqrt(limit), window)) {
                window = {u, u, v, v};
                return tree_search().sum_of_roots(from);
            }
            const int size = kernels_.collect(windows.rows(window), from, limit, found_.data());
            if (size < k_) {
                const float wanted = static_cast<float>(k_) / static_cast<float>(std::max(size, 1));
                limit *= std::clamp(kHeadroom * wanted, 1.2F, 4.0F);
                continue;
            }
            const Rank rank = rank_of(kernels_, found_.data(), size, k_, limit);
            guess = std::max(rank.limit * kHeadroom, 1e-12F);
            return sum_of_smallest_roots(kernels_, found_.data(), size, k_, rank);
        }
    }

    const Cloud& cloud_;
    int k_;
    std::vector<float> mean_;
    const DistanceKernels& kernels_ = distance_kernels();
    std::vector<float> found_;
    std::unique_ptr<TreeSearch> tree_search_;
};

/// PCL's formula: points without a reading count in the sums, with 0, but not in their number.
double threshold_of(const std::vector<float>& distances, std::size_t valid, double factor) {
    double sum = 0.0;
    double squares = 0.0;
    for (const float distance : distances) {
        sum += distance;
        squares += distance * distance;
    }
    const auto n = static_cast<double>(valid);
    const double variance = (squares - sum * sum / n) / (n - 1.0);
    return sum / n + factor * std::sqrt(variance);
}

Result<void> check(const OutlierSettings& settings) {
    if (settings.neighbours < 1 || settings.neighbours > OutlierSettings::kMostNeighbours)
        return fail(
            ErrorCode::invalid_argument,
            "neighbours",
            "is " + std::to_string(settings.neighbours),
            "give a whole number from 1 to " + std::to_string(OutlierSettings::kMostNeighbours)
        );
    if (!std::isfinite(settings.sigma_factor) || settings.sigma_factor < 0.0)
        return fail(
            ErrorCode::invalid_argument,
            "sigma_factor",
            "is " + std::to_string(settings.sigma_factor),
            "give a number of standard deviations that is not negative, such as 1"
        );
    return {};
}

}  // namespace

Result<Outliers> find_outliers(const Cloud& cloud, const OutlierSettings& settings) {
    if (auto right = check_shape(cloud); !right) return tl::unexpected(right.error());
    if (auto right = check(settings); !right) return tl::unexpected(right.error());

    std::size_t valid = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        valid += cloud.valid(i) ? 1 : 0;
    Outliers result;
    result.mask.assign(cloud.size(), 0);
    result.mean_distance.assign(cloud.size(), 0.0F);
    if (valid == 0) return result;
    if (valid <= static_cast<std::size_t>(settings.neighbours))
        return fail(
            ErrorCode::invalid_argument,
            "neighbours",
            "is " + std::to_string(settings.neighbours) + ", but the cloud has only " +
                std::to_string(valid) + " points with a reading",
            "give fewer neighbours than there are points"
        );

    result.mean_distance = MeanDistances(cloud, settings.neighbours).find();
    result.threshold_m = threshold_of(result.mean_distance, valid, settings.sigma_factor);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const bool out = result.mean_distance[i] > result.threshold_m;
        result.mask[i] = out ? 1 : 0;
        result.count += out ? 1 : 0;
    }
    return result;
}

void clear_points(Cloud& cloud, const std::vector<std::uint8_t>& mask) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (mask[i] != 0) cloud.x[i] = cloud.y[i] = cloud.z[i] = kNone;
}

}  // namespace kinectlab
