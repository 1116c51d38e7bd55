#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/cloud.hpp"
#include "pipeline/preprocess/distance_kernels.hpp"

namespace kinectlab {

/// A k-d tree over the points of any cloud that have a reading, balanced whatever they are (two
/// million equal ones included). Its leaves lie one after the other, each padded with NaN to
/// eights. Thread-safe once made.
class PointTree {
public:
    explicit PointTree(const Cloud& cloud);

    /// Calls visit(leaf) for the leaves that may hold points with a squared distance below `limit`,
    /// the nearer ones first; visit may lower `limit` meanwhile.
    template <class Visit>
    void visit_within(Point3 from, const float& limit, Visit&& visit) const {
        if (!nodes_.empty()) visit_node(0, from, limit, visit);
    }

    struct Leaf {
        std::uint32_t begin = 0;  ///< first place, a multiple of eight
        std::uint32_t count = 0;  ///< points
    };
    [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
    /// All points by their places, padded with NaN to where eight more can be read.
    [[nodiscard]] const float* x() const { return x_.data(); }
    [[nodiscard]] const float* y() const { return y_.data(); }
    [[nodiscard]] const float* z() const { return z_.data(); }
    [[nodiscard]] Point3 point(std::uint32_t place) const {
        return {x_[place], y_[place], z_[place]};
    }
    /// Where the point at a place stands in the cloud.
    [[nodiscard]] std::uint32_t index(std::uint32_t place) const { return index_[place]; }
    [[nodiscard]] std::size_t size() const { return points_; }

    static constexpr int kLeafSize = 64;

private:
    struct Node {
        std::array<float, 3> low, high;
        std::int32_t second = 0;  ///< the first child follows its parent; 0 in a leaf
        std::int32_t leaf = 0;
    };
    void build(const Cloud& cloud, std::span<std::uint32_t> order);
    void add_leaf(const Cloud& cloud, std::span<const std::uint32_t> order);
    [[nodiscard]] static float squared_distance(const Node& node, Point3 from);

    template <class Visit>
    void visit_node(std::size_t at, Point3 from, const float& limit, Visit& visit) const {
        const Node& node = nodes_[at];
        if (node.second == 0) {
            visit(leaves_[static_cast<std::size_t>(node.leaf)]);
            return;
        }
        std::size_t near = at + 1;
        auto far = static_cast<std::size_t>(node.second);
        float to_near = squared_distance(nodes_[near], from);
        float to_far = squared_distance(nodes_[far], from);
        if (to_far < to_near) {
            std::swap(near, far);
            std::swap(to_near, to_far);
        }
        if (to_near < limit) visit_node(near, from, limit, visit);
        if (to_far < limit) visit_node(far, from, limit, visit);
    }

    std::size_t points_ = 0;
    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
    std::vector<float> x_, y_, z_;
    std::vector<std::uint32_t> index_;
};

/// Rounds as DistanceKernels do, and rounding keeps order: never above a point's own distance.
inline float PointTree::squared_distance(const Node& node, Point3 from) {
    const auto outside = [](float low, float value, float high) {
        return std::max(std::max(low - value, value - high), 0.0F);
    };
    const float dx = outside(node.low[0], from.x, node.high[0]);
    const float dy = outside(node.low[1], from.y, node.high[1]);
    const float dz = outside(node.low[2], from.z, node.high[2]);
    return dx * dx + dy * dy + dz * dz;
}

}  // namespace kinectlab
