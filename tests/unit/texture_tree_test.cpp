// Quad trees, their squares for the GPU, and the indirection texture they are placed in.
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "runtime/texture/indirection_allocator.h"
#include "runtime/texture/page_tree.h"

namespace {

using namespace loam;

// What indirection.comp does; counts writes a texel so that overlapping squares show.
struct Table {
    explicit Table(int side)
        : side(side),
          width(side * 3 / 2),
          texels(size_t(side) * size_t(width), 0x12345678u),
          writes(texels.size(), 0) {}
    void fill(const std::vector<shared::IndirectionFill>& fills) {
        std::fill(writes.begin(), writes.end(), 0);
        for (const auto& f : fills)
            for (int y = f.y; y < f.y + f.size; ++y)
                for (int x = f.x; x < f.x + f.size; ++x) {
                    texels[size_t(y) * size_t(width) + size_t(x)] = f.value;
                    ++writes[size_t(y) * size_t(width) + size_t(x)];
                }
    }
    [[nodiscard]] int most_writes() const { return *std::max_element(writes.begin(), writes.end()); }
    int side, width;
    std::vector<uint32_t> texels;
    std::vector<int> writes;
};

int differing_cells(const PageTree& tree, const Table& table, glm::ivec2 origin) {
    int count = 0;
    for (int level = 0; level <= tree.log2_width(); ++level) {
        const int depth = tree.log2_width() - level;
        const glm::ivec2 at = shared::vt_level_origin(level, table.side) + (origin >> level);
        for (int y = 0; y < 1 << depth; ++y)
            for (int x = 0; x < 1 << depth; ++x)
                count += table.texels[size_t(at.y + y) * size_t(table.width) + size_t(at.x + x)] !=
                         tree.shown(depth, x, y);
    }
    return count;
}

// Random pages come and go; now and then the delta is applied. `lose`: drop a square a time, to see the test
// fail.
int random_traffic(int steps, bool lose) {
    constexpr int kLog2 = 5;
    std::mt19937 random(7);
    PageTree tree(kLog2);
    tree.touch_all();
    Table table(64);
    const glm::ivec2 origin(32, 0);
    int wrong = 0;
    for (int step = 0; step < steps; ++step) {
        const int depth = int(random() % (kLog2 + 1));
        const int x = int(random() % (1u << depth)), y = int(random() % (1u << depth));
        tree.set(depth, x, y, random() % 3 == 0 ? kNoPage : uint32_t(random() & 0xffffff));
        if (random() % 4 != 0) continue;
        std::vector<shared::IndirectionFill> fills;
        tree.take_fills(origin, table.side, fills);
        if (lose && !fills.empty()) fills.pop_back();
        table.fill(fills);
        EXPECT_LE(table.most_writes(), 1) << "squares overlap";
        EXPECT_FALSE(tree.changed());
        wrong += differing_cells(tree, table, origin);
    }
    return wrong;
}

TEST(PageTree, TheDeltasMakeTheTable) {
    EXPECT_EQ(random_traffic(10'000, false), 0);
}

TEST(PageTree, ALostSquareIsSeen) {
    EXPECT_GT(random_traffic(200, true), 0);
}

TEST(PageTree, NothingChangedNothingWritten) {
    PageTree tree(4);
    tree.set(0, 0, 0, 1);
    tree.set(4, 3, 9, 2);
    std::vector<shared::IndirectionFill> fills;
    tree.take_fills({0, 0}, 16, fills);
    EXPECT_FALSE(fills.empty());
    fills.clear();
    tree.set(4, 3, 9, 2);
    tree.take_fills({0, 0}, 16, fills);
    EXPECT_TRUE(fills.empty());
}

TEST(PageTree, AHoleShowsTheAncestor) {
    PageTree tree(3);
    EXPECT_EQ(tree.shown(3, 5, 5), kNoPage);
    tree.set(0, 0, 0, 10);
    tree.set(3, 5, 5, 13);
    EXPECT_EQ(tree.shown(3, 5, 5), 13u);
    EXPECT_EQ(tree.shown(3, 4, 5), 10u);
    tree.set(0, 0, 0, kNoPage);
    EXPECT_EQ(tree.shown(3, 4, 5), kNoPage);
    EXPECT_EQ(tree.page_count(), 1);
}

TEST(PageTree, AMipShowsNoFinerPage) {
    PageTree tree(3);
    tree.set(0, 0, 0, 10);
    tree.set(3, 5, 5, 13);
    EXPECT_EQ(tree.shown(2, 2, 2), 10u);
    tree.set(1, 1, 1, 11);
    EXPECT_EQ(tree.shown(2, 2, 2), 11u);
    EXPECT_EQ(tree.shown(0, 0, 0), 10u);
    EXPECT_EQ(tree.shown(3, 5, 5), 13u);
}

TEST(IndirectionMips, LieBesideMipZeroAndApart) {
    constexpr int kSize = 64;
    std::vector<int> covered(size_t(kSize) * kSize * 3 / 2, 0);
    for (int level = 0; kSize >> level > 0; ++level) {
        const glm::ivec2 at = shared::vt_level_origin(level, kSize);
        for (int y = 0; y < kSize >> level; ++y)
            for (int x = 0; x < kSize >> level; ++x) {
                ASSERT_LT(at.x + x, kSize * 3 / 2);
                ASSERT_LT(at.y + y, kSize);
                ++covered[size_t(at.y + y) * (kSize * 3 / 2) + size_t(at.x + x)];
            }
    }
    EXPECT_EQ(*std::max_element(covered.begin(), covered.end()), 1);
}

TEST(PageTree, TouchingWritesEveryCellAgain) {
    PageTree tree(4);
    tree.set(0, 0, 0, 1);
    tree.set(2, 1, 3, 2);
    tree.set(4, 15, 0, 3);
    std::vector<shared::IndirectionFill> fills;
    tree.take_fills({0, 0}, 16, fills);
    tree.touch_all();
    fills.clear();
    tree.take_fills({0, 0}, 16, fills);
    Table table(16);
    table.fill(fills);
    EXPECT_EQ(differing_cells(tree, table, {0, 0}), 0);
}

TEST(IndirectionAllocator, SquaresAreAlignedAndDisjoint) {
    std::mt19937 random(3);
    IndirectionAllocator allocator(8);
    struct Square {
        glm::ivec2 origin;
        int log2;
    };
    std::vector<Square> held;
    std::vector<uint8_t> used(256 * 256, 0);
    const auto mark = [&](const Square& s, int by) {
        for (int y = 0; y < 1 << s.log2; ++y)
            for (int x = 0; x < 1 << s.log2; ++x) {
                auto& u = used[size_t(s.origin.y + y) * 256 + size_t(s.origin.x + x)];
                u = uint8_t(u + by);
                ASSERT_LE(u, 1);
            }
    };
    for (int step = 0; step < 4000; ++step) {
        if (random() % 2 == 0 || held.empty()) {
            const int log2 = int(random() % 7);
            if (const auto origin = allocator.allocate(log2)) {
                ASSERT_EQ(origin->x & ((1 << log2) - 1), 0);
                ASSERT_EQ(origin->y & ((1 << log2) - 1), 0);
                held.push_back({*origin, log2});
                mark(held.back(), 1);
            }
        } else {
            const size_t i = random() % held.size();
            mark(held[i], -1);
            allocator.release(held[i].origin, held[i].log2);
            held.erase(held.begin() + std::ptrdiff_t(i));
        }
    }
    for (const Square& s : held) allocator.release(s.origin, s.log2);
    EXPECT_EQ(allocator.free_texels(), 256 * 256);
    EXPECT_TRUE(allocator.allocate(8).has_value()) << "an empty texture is one square again";
    EXPECT_FALSE(allocator.allocate(0).has_value());
}

}  // namespace
