#include "pipeline/preprocess/mean_distances.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "pipeline/preprocess/distance_kernels.hpp"
#include "pipeline/preprocess/pixel_window.hpp"
#include "pipeline/preprocess/point_tree.hpp"

namespace kinectlab {
namespace {

// The K-th neighbour is about as far away as expected: looking this much farther rarely fails.
constexpr float kHeadroom = 1.12F;
// A tree takes about as long to build as looking at this many points for each of the cloud's.
constexpr double kTreeCost = 200.0;
constexpr int kWideWindow = 96 * 96;

/// Searches a tree for the K nearest and keeps what it learns for the next point.
class TreeSearch {
public:
    TreeSearch(const Cloud& cloud, int k)
        : tree_(cloud), k_(k), most_(4 * k + PointTree::kLeafSize), found_(buffer_size(most_)) {}

    [[nodiscard]] const PointTree& tree() const { return tree_; }

    double sum_of_distances(Point3 from) {
        collect(from, last_ * kHeadroom);
        if (size_ < k_) collect(from, std::numeric_limits<float>::infinity());
        const SumOfRoots nearest = kernels_.sum_smallest(found_.data(), size_, k_, limit_);
        last_ = nearest.last;
        return nearest.sum;
    }

private:
    static std::size_t buffer_size(int most) {
        return static_cast<std::size_t>(
            most + PointTree::kLeafSize + 8 + DistanceKernels::kPadding
        );
    }

    void collect(Point3 from, float limit) {
        size_ = 0;
        limit_ = limit;
        tree_.visit_within(from, limit_, [&](const PointTree::Leaf& leaf) {
            const Strip strip{leaf.begin, static_cast<int>((leaf.count + 7) / 8)};
            const PointStrips points{tree_.x(), tree_.y(), tree_.z(), 8, {&strip, 1}};
            size_ += kernels_.collect(points, from, limit_, found_.data() + size_);
            if (size_ > most_) keep_nearest();
        });
    }

    /// Forgets all but K; what is as far as the farthest of them cannot change the sum.
    void keep_nearest() {
        const auto last = found_.begin() + (k_ - 1);
        std::nth_element(found_.begin(), last, found_.begin() + size_);
        size_ = k_;
        limit_ = *last;
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

/// What one point's neighbours tell of the next one's.
struct Expected {
    float z = 0.0F;
    std::size_t pixel = 0;
    float last = 1e-4F;  ///< m², to the K-th; at first about K = 100 at 1 m; corrected at once
};

/// A depth camera's readings lie in layers, and a point has as many near neighbours as its layer
/// has: the best guess is what was found for the last point of the same depth, not for the last.
class Expectations {
public:
    Expected& at(float z, std::size_t pixel) {
        Expected& entry = entries_[std::bit_cast<std::uint32_t>(z) * 0x9E3779B1U >> 24U];
        if (entry.z != z || pixel - entry.pixel > kFreshPixels) entry = *newest_;
        entry.z = z;
        entry.pixel = pixel;
        newest_ = &entry;
        return entry;
    }

private:
    static constexpr std::size_t kFreshPixels = 64;
    std::array<Expected, 256> entries_;
    Expected* newest_ = entries_.data();
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
                mean_[tree.index(place)] = mean_of(search.sum_of_distances(tree.point(place)));
    }

    void search_windows(const PixelWindows& windows) {
        wide_left_ = kTreeCost * static_cast<double>(cloud_.size());
        Expectations expectations;
        std::size_t i = 0;
        for (int v = 0; v < cloud_.height; ++v)
            for (int u = 0; u < cloud_.width; ++u, ++i) {
                if (!cloud_.valid(i)) continue;
                const Point3 from{cloud_.x[i], cloud_.y[i], cloud_.z[i]};
                Expected& expected = expectations.at(from.z, i);
                mean_[i] = mean_of(sum_in_window(windows, u, v, from, expected));
            }
    }

    double sum_in_window(
        const PixelWindows& windows, int u, int v, Point3 from, Expected& expected
    ) {
        for (float limit = expected.last * kHeadroom;;) {
            windows.fit(u, v, from, std::sqrt(limit), strips_);
            if (!worth_a_look()) return tree_search().sum_of_distances(from);
            const int size = kernels_.collect(windows.points(strips_), from, limit, found_.data());
            if (size < k_) {
                const float wanted = static_cast<float>(k_) / static_cast<float>(std::max(size, 1));
                limit *= std::clamp(kHeadroom * wanted, 1.2F, 4.0F);
                continue;
            }
            const SumOfRoots nearest = kernels_.sum_smallest(found_.data(), size, k_, limit);
            expected.last = std::max(nearest.last, 1e-12F);
            return nearest.sum;
        }
    }

    /// Makes room for what the strips hold. False once wide windows have cost as much as a tree.
    bool worth_a_look() {
        int pixels = 0;
        for (const Strip& strip : strips_)
            pixels += 8 * strip.rows;
        if (pixels > kWideWindow) {
            wide_left_ -= pixels;
            if (wide_left_ < 0.0) return false;
        }
        const auto room = static_cast<std::size_t>(pixels + 8 + DistanceKernels::kPadding);
        if (found_.size() < room) found_.resize(room);
        return true;
    }

    const Cloud& cloud_;
    int k_;
    std::vector<float> mean_;
    const DistanceKernels& kernels_ = distance_kernels();
    std::vector<Strip> strips_;
    std::vector<float> found_;
    double wide_left_ = 0.0;
    std::unique_ptr<TreeSearch> tree_search_;
};

}  // namespace

std::vector<float> mean_distances(const Cloud& cloud, int neighbours) {
    return MeanDistances(cloud, neighbours).find();
}

}  // namespace kinectlab
