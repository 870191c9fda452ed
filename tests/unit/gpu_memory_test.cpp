// The free list of device memory, without a device.
#include "runtime/gpu/memory.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace loam::gpu {
namespace {

TEST(GpuMemory, FirstFitTakesTheLowestHole) {
    FreeList list(1000);
    EXPECT_EQ(list.allocate(100, 1), 0u);
    EXPECT_EQ(list.allocate(100, 1), 100u);
    EXPECT_EQ(list.allocate(100, 1), 200u);
    list.release(100, 100);
    EXPECT_EQ(list.allocate(60, 1), 100u);
    EXPECT_EQ(list.allocate(60, 1), 300u);
}

TEST(GpuMemory, AlignmentGapsStayFree) {
    FreeList list(1024);
    EXPECT_EQ(list.allocate(10, 1), 0u);
    EXPECT_EQ(list.allocate(100, 256), 256u);
    EXPECT_EQ(list.free_bytes(), 1024u - 110u);
    EXPECT_EQ(list.allocate(246, 1), 10u);  // the gap
}

TEST(GpuMemory, RefusesWhatDoesNotFit) {
    FreeList list(256);
    EXPECT_FALSE(list.allocate(257, 1));
    EXPECT_EQ(list.allocate(1, 1), 0u);
    EXPECT_FALSE(list.allocate(1, 256));  // only the alignment is in the way
    EXPECT_EQ(list.allocate(255, 1), 1u);
    EXPECT_FALSE(list.allocate(1, 1));
    EXPECT_EQ(list.free_bytes(), 0u);
}

TEST(GpuMemory, NeighboursMergeWhicheverGoesFirst) {
    int order[] = {0, 1, 2};
    do {
        FreeList list(300);
        for (int i = 0; i < 3; ++i) ASSERT_TRUE(list.allocate(100, 1));
        for (const int i : order) list.release(static_cast<uint64_t>(i) * 100, 100);
        EXPECT_TRUE(list.empty());
        EXPECT_EQ(list.range_count(), 1u);
        EXPECT_EQ(list.allocate(300, 1), 0u);
    } while (std::ranges::next_permutation(order).found);
}

TEST(GpuMemory, RandomTrafficNeverOverlapsAndLeavesNothing) {
    constexpr uint64_t kSize = 1 << 16;
    std::mt19937 random(7);
    FreeList list(kSize);
    std::vector<uint8_t> taken(kSize, 0);  // the slow model: a byte a byte
    struct Piece {
        uint64_t offset, size;
    };
    std::vector<Piece> live;
    const auto release = [&](size_t i) {
        list.release(live[i].offset, live[i].size);
        std::fill_n(taken.begin() + static_cast<std::ptrdiff_t>(live[i].offset), live[i].size, uint8_t(0));
        live[i] = live.back();
        live.pop_back();
    };
    for (int step = 0; step < 20000; ++step) {
        if (!live.empty() && random() % 100 < 48) {
            release(random() % live.size());
            continue;
        }
        const uint64_t size = 1 + random() % (random() % 8 == 0 ? 8000 : 300);
        const uint64_t alignment = 1ull << (random() % 10);
        const auto offset = list.allocate(size, alignment);
        if (!offset) continue;
        ASSERT_EQ(*offset % alignment, 0u);
        ASSERT_LE(*offset + size, kSize);
        for (uint64_t i = *offset; i < *offset + size; ++i) {
            ASSERT_EQ(taken[i], 0) << "step " << step;
            taken[i] = 1;
        }
        live.push_back({*offset, size});
        uint64_t used = 0;
        for (const Piece& piece : live) used += piece.size;
        ASSERT_EQ(list.free_bytes(), kSize - used);
    }
    while (!live.empty()) release(live.size() - 1);
    EXPECT_TRUE(list.empty());
    EXPECT_EQ(list.range_count(), 1u);
}

TEST(GpuMemoryDeathTest, ReleasingTwiceIsABug) {
    FreeList list(100);
    ASSERT_TRUE(list.allocate(50, 1));
    list.release(0, 50);
    EXPECT_DEATH(list.release(0, 50), "free already");
}

}  // namespace
}  // namespace loam::gpu
