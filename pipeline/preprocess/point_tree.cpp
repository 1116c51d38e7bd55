#include "pipeline/preprocess/point_tree.hpp"

#include <algorithm>
#include <limits>

namespace kinectlab {

PointTree::PointTree(const Cloud& cloud) {
    std::vector<std::uint32_t> order;
    order.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (cloud.valid(i)) order.push_back(static_cast<std::uint32_t>(i));
    points_ = order.size();
    if (!order.empty()) build(cloud, order);
}

void PointTree::build(const Cloud& cloud, std::span<std::uint32_t> order) {
    const std::array<const float*, 3> axes{cloud.x.data(), cloud.y.data(), cloud.z.data()};
    Node node;
    std::size_t longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        node.low[k] = std::numeric_limits<float>::infinity();
        node.high[k] = -node.low[k];
        for (const std::uint32_t i : order) {
            node.low[k] = std::min(node.low[k], axes[k][i]);
            node.high[k] = std::max(node.high[k], axes[k][i]);
        }
        if (node.high[k] - node.low[k] > node.high[longest] - node.low[longest]) longest = k;
    }
    const std::size_t at = nodes_.size();
    node.leaf = static_cast<std::int32_t>(leaves_.size());
    nodes_.push_back(node);
    if (order.size() <= kLeafSize) {
        add_leaf(cloud, order);
        return;
    }
    const auto half = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
    const float* axis = axes[longest];
    std::nth_element(order.begin(), half, order.end(), [axis](std::uint32_t a, std::uint32_t b) {
        return axis[a] < axis[b];
    });
    build(cloud, {order.begin(), half});
    nodes_[at].second = static_cast<std::int32_t>(nodes_.size());
    build(cloud, {half, order.end()});
}

void PointTree::add_leaf(const Cloud& cloud, std::span<const std::uint32_t> order) {
    leaves_.push_back(
        {static_cast<std::uint32_t>(x_.size()), static_cast<std::uint32_t>(order.size())}
    );
    for (const std::uint32_t i : order) {
        x_.push_back(cloud.x[i]);
        y_.push_back(cloud.y[i]);
        z_.push_back(cloud.z[i]);
        index_.push_back(i);
    }
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    while (x_.size() % 8 != 0) {
        for (auto* axis : {&x_, &y_, &z_})
            axis->push_back(kNone);
        index_.push_back(std::numeric_limits<std::uint32_t>::max());
    }
}

}  // namespace kinectlab
