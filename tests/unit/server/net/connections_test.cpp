#include "server/net/connections.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace kinectlab::net {
namespace {

TEST(Connections, AreBoundedInAllAndForEachAddress) {
    Connections connections(3, 2);
    auto first = connections.admit("a");
    auto second = connections.admit("a");
    EXPECT_FALSE(connections.admit("a"));
    auto other = connections.admit("b");
    ASSERT_TRUE(first && second && other);
    EXPECT_FALSE(connections.admit("c"));
    second.reset();
    EXPECT_EQ(connections.count(), 2U);
    EXPECT_TRUE(connections.admit("a"));
}

TEST(Connections, ClosingMayEndThemAtOnce) {
    Connections connections(10, 10);
    std::vector<std::unique_ptr<Connections::Place>> places;
    for (int i = 0; i < 3; ++i) {
        places.push_back(connections.admit("a"));
        places.back()->close_soon = [&places] {
            places.clear();
        };
    }
    connections.close_all_soon();
    EXPECT_EQ(connections.count(), 0U);
}

}  // namespace
}  // namespace kinectlab::net
