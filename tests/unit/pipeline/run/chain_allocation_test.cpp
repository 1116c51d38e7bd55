#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "tests/unit/pipeline/support/ball_room.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}

// Counts what this whole test program allocates; only differences are looked at.
void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size == 0 ? 1 : size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace kinectlab {
namespace {

TEST(ChainAllocation, NoneOnceWarm) {
    test::BallRoom room;
    ChainSettings settings;
    settings.camera = room.camera;
    settings.objects = {
        {"bob", SphereSettings{.radius_m = 0.05}},
        {"ball", SphereSettings{}},
        {"moved", ChangeTrackSettings{}}};
    Chain chain = std::move(Chain::create(settings).value());
    ASSERT_TRUE(chain.learn(room.frame({})));

    std::vector<RgbdFrame> frames;
    for (int i = 0; i < 8; ++i)
        frames.push_back(room.frame({{{0.05 * i, 0.0, 1.2}, 0.05}, {{-0.3, 0.1, 1.0}, 0.08}}));
    // Somebody walks through the picture: far more changes than before.
    frames.push_back(room.frame({{{0.0, 0.0, 1.0}, 0.6}}));
    ASSERT_TRUE(chain.track(frames.front()));

    const std::size_t before = allocations;
    bool all_tracked = true;
    for (const auto& frame : frames)
        all_tracked = all_tracked && chain.track(frame).has_value();
    EXPECT_EQ(allocations - before, 0U);
    EXPECT_TRUE(all_tracked);
}

}  // namespace
}  // namespace kinectlab
