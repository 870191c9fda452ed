// The invariants of the page pool under random traffic.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "runtime/texture/page_pool.h"

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

TEST(PagePool, APageThatLacksInputsIsTriedAtGrowingIntervals) {
    PagePool pool(3);
    const int place = pool.take(page(1), 10);
    pool.mark_low_res(place, 4, 10);
    EXPECT_TRUE(pool.place(place).low_res);
    EXPECT_EQ(pool.place(place).retry_frame, 25u);
    pool.mark_low_res(place, 3, 25);
    EXPECT_EQ(pool.place(place).retry_frame, 55u);
    pool.mark_low_res(place, 3, 55);
    EXPECT_EQ(pool.place(place).retry_frame, 115u);
    pool.mark_low_res(place, 3, 115);
    EXPECT_EQ(pool.place(place).retry_frame, 175u);
    pool.clear_low_res(place);
    pool.mark_low_res(place, 3, 200);
    EXPECT_EQ(pool.place(place).retry_frame, 215u) << "from the start again";
}

}  // namespace
