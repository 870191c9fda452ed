// The invariants of the page pool under random traffic, and the choice of live sectors.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "runtime/texture/page_pool.h"
#include "runtime/texture/sector_set.h"

namespace {

using namespace loam;
using State = PagePool::State;

PageId page(int n) {
    return {{}, 6, n % 64, n / 64};
}

TEST(PagePool, RandomTrafficKeepsTheInvariants) {
    std::mt19937 random(11);
    PagePool pool(5);
    const int root = pool.take(PageId{}, 1);
    ASSERT_EQ(root, 0);
    std::map<int, uint64_t> left_tree;  // place → frame
    uint64_t recycled = 0;
    for (uint64_t frame = 2; frame < 4000; ++frame) {
        pool.promote(frame, [&](int place) { EXPECT_LT(pool.place(place).last_requested, frame); });
        for (int i = 0; i < 3; ++i) {
            const PageId wanted = page(int(random() % 60));
            const int found = pool.find(wanted);
            if (found >= 0) {
                pool.touch(found, frame);
                if (pool.place(found).state == State::resting && pool.place(found).dirty.empty()) {
                    pool.revive(found, frame);
                    left_tree.erase(found);
                }
                continue;
            }
            const int place = pool.take(wanted, frame);
            if (place < 0) continue;
            EXPECT_NE(place, root);
            EXPECT_TRUE(pool.place(place).dirty.empty());
            EXPECT_EQ(pool.find(wanted), place);
            if (left_tree.contains(place)) {
                EXPECT_GE(frame, left_tree[place] + PagePool::kRestFrames) << "recycled too early";
                left_tree.erase(place);
                ++recycled;
            }
        }
        const auto old = pool.retirable(frame);
        for (size_t i = 1; i < old.size(); ++i)
            EXPECT_LE(pool.place(old[i - 1]).last_requested, pool.place(old[i]).last_requested);
        if (!old.empty()) {
            EXPECT_NE(old[0], root);
            pool.retire(old[0], frame);
            left_tree[old[0]] = frame;
        }
        int used = 0;
        for (int i = 0; i < pool.place_count(); ++i)
            if (pool.place(i).state != State::free) {
                ++used;
                EXPECT_EQ(pool.find(pool.place(i).page), i);
            }
        EXPECT_EQ(used, pool.used_count());
    }
    EXPECT_GT(recycled, 100u);
    EXPECT_EQ(pool.place(root).page, PageId{});
    EXPECT_EQ(pool.place(root).state, State::usable);
}

TEST(PagePool, DirtReachesRestingPages) {
    PagePool pool(2);
    const int place = pool.take(page(1), 1);
    pool.promote(2, [](int) {});
    pool.retire(place, 10);
    pool.mark_dirty(place, {0, 0, 8, 8});
    EXPECT_EQ(pool.place(place).dirty, (TexelRect{0, 0, 8, 8}));
    EXPECT_EQ(pool.takeable_count(10), 2);  // two free ones
    EXPECT_EQ(pool.takeable_count(13), 3);
}

TEST(PagePool, APageIsNotUsableInItsOwnFrame) {
    PagePool pool(2);
    const int place = pool.take(page(1), 5);
    int visits = 0;
    pool.promote(5, [&](int) { ++visits; });
    EXPECT_EQ(visits, 0);
    pool.promote(6, [&](int p) { visits += p == place; });
    EXPECT_EQ(visits, 1);
}

SectorSetDesc sector_desc(int max_live, int log2_size) {
    return {.layout = {.default_log2_width = 5, .default_log2_page = 0, .sector_log2_width = 4},
            .indirection_log2_size = log2_size,
            .max_live = max_live,
            .bounds = {0, 0, 2048, 2048}};
}

TEST(SectorSet, OnlyWantedSectorsInsideTheRadiusLive) {
    SectorSet sectors(sector_desc(8, 7));
    sectors.want({10, 10}, 1);
    sectors.want({30, 30}, 1);
    EXPECT_TRUE(sectors.update({10.5 * 64, 10.5 * 64}, 130, 1).empty());
    ASSERT_EQ(sectors.live().size(), 1u);
    EXPECT_EQ(sectors.live()[0].sector, glm::ivec2(10, 10));
    // Not in the table before its root page is usable.
    std::vector<uint32_t> table(kSectorTableSide * kSectorTableSide);
    sectors.write_table({10, 10}, table);
    EXPECT_EQ(table[32 * 64 + 32], 0u);
    sectors.live()[0].in_table = true;
    sectors.write_table({10, 10}, table);
    const LiveSector& s = sectors.live()[0];
    EXPECT_EQ(table[32 * 64 + 32], uint32_t(s.id) | uint32_t(s.origin.x) << 8 | uint32_t(s.origin.y) << 20);
}

TEST(SectorSet, WhenFullTheFarthestMakesWayForAMuchNearerOneOnly) {
    SectorSet sectors(sector_desc(2, 7));
    const glm::dvec2 camera(0.5 * 64, 0.5 * 64);
    sectors.want({8, 0}, 1);
    sectors.want({7, 0}, 1);
    sectors.update(camera, 1000, 1);
    ASSERT_EQ(sectors.live().size(), 2u);
    sectors.want({6, 0}, 2);  // not much nearer
    EXPECT_TRUE(sectors.update(camera, 1000, 2).empty());
    sectors.want({1, 0}, 3);
    const auto dropped = sectors.update(camera, 1000, 3);
    ASSERT_EQ(dropped.size(), 1u);
    EXPECT_EQ(dropped[0].sector_x, 8);
    EXPECT_NE(sectors.find({1, 0}), nullptr);
}

TEST(SectorSet, AFullIndirectionTextureLeavesSectorsOnTheDefault) {
    SectorSet sectors(sector_desc(200, 6));  // 64²: the default takes a quarter, 12 images of 16² remain
    for (int i = 0; i < 20; ++i) sectors.want({i, 0}, 1);
    sectors.update({0, 0}, 5000, 1);
    EXPECT_EQ(sectors.live().size(), 12u);
    for (const LiveSector& s : sectors.live()) EXPECT_LT(s.sector.x, 12) << "the nearest come first";
}

TEST(SectorSet, LeavesBeyondTheRadiusOrWhenIdle) {
    SectorSet sectors(sector_desc(8, 7));
    sectors.want({4, 4}, 1);
    sectors.update({4.5 * 64, 4.5 * 64}, 100, 1);
    EXPECT_TRUE(sectors.update({4.5 * 64 + 150, 4.5 * 64}, 100, 2).empty()) << "hysteresis";
    EXPECT_EQ(sectors.update({4.5 * 64 + 170, 4.5 * 64}, 100, 3).size(), 1u);
    sectors.want({4, 4}, 4);
    sectors.update({4.5 * 64, 4.5 * 64}, 100, 4);
    EXPECT_EQ(sectors.update({4.5 * 64, 4.5 * 64}, 100, 5 + SectorSet::kIdleFrames).size(), 1u);
    EXPECT_TRUE(sectors.live().empty());
}

}  // namespace
