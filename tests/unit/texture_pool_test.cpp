// The invariants of the page pool under random traffic.
#include <algorithm>
#include <map>
#include <random>
#include <string>

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

// What happened to a place, in order.
struct PoolEvent {
    enum class Kind { left_tree, taken, revived } kind;
    int place;
    uint64_t frame;
    uint64_t last_requested;  // of the page that was in the place
    uint64_t oldest;          // last request of the oldest page that could be taken, for `taken`
};

// Empty: no place was handed out within three frames of its page leaving the tree, and always the oldest was.
std::string pool_fault(const std::vector<PoolEvent>& events) {
    std::map<int, uint64_t> left;
    for (const PoolEvent& e : events) {
        if (e.kind == PoolEvent::Kind::left_tree) left[e.place] = e.frame;
        if (e.kind == PoolEvent::Kind::revived) left.erase(e.place);
        if (e.kind != PoolEvent::Kind::taken) continue;
        if (left.contains(e.place) && e.frame < left[e.place] + 3) return "handed out within three frames";
        if (e.last_requested > e.oldest) return "an older page was left";
        left.erase(e.place);
    }
    return "";
}

std::vector<PoolEvent> pool_traffic(uint32_t seed, const PagePoolRules& rules) {
    std::mt19937 random(seed);
    PagePool pool(4, rules);
    (void)pool.take(PageId{}, 1);
    std::vector<PoolEvent> events;
    for (uint64_t frame = 2; frame < 1500; ++frame) {
        pool.promote(frame, [](int) {});
        for (int i = 0; i < 2; ++i) {
            const PageId wanted = page(int(random() % 50));
            if (const int found = pool.find(wanted); found >= 0) {
                pool.touch(found, frame);
                if (pool.place(found).state != State::resting) continue;
                pool.revive(found, frame);
                events.push_back({PoolEvent::Kind::revived, found, frame, 0, 0});
                continue;
            }
            uint64_t oldest = UINT64_MAX;
            std::vector<uint64_t> requested;
            for (int p = 0; p < pool.place_count(); ++p) {
                const PagePool::Place& place = pool.place(p);
                requested.push_back(place.last_requested);
                if (place.state == State::resting && place.changed + PagePool::kRestFrames <= frame)
                    oldest = std::min(oldest, place.last_requested);
            }
            const int place = pool.take(wanted, frame);
            if (place >= 0)
                events.push_back({PoolEvent::Kind::taken, place, frame, requested[size_t(place)], oldest});
        }
        const auto old = pool.retirable(frame);
        if (old.empty()) continue;
        EXPECT_GE(frame - pool.place(old[0]).last_requested, uint64_t(rules.age_frames));
        pool.retire(old[0], frame);
        events.push_back({PoolEvent::Kind::left_tree, old[0], frame, 0, 0});
    }
    return events;
}

TEST(PagePool, NoPlaceIsHandedOutWithinThreeFramesAndTheOldestIsFirst) {
    for (const int age : {1, 3, 10})
        for (uint32_t seed = 1; seed < 6; ++seed) {
            const auto events = pool_traffic(seed, {.age_frames = age});
            EXPECT_EQ(pool_fault(events), "");
            EXPECT_GT(std::count_if(events.begin(), events.end(),
                                    [](const PoolEvent& e) { return e.kind == PoolEvent::Kind::taken; }),
                      100);
        }
}

TEST(PagePool, APlaceHandedOutTooSoonOrOutOfOrderIsFound) {
    const auto events = pool_traffic(2, {});
    auto early = events, unordered = events;
    // A recycled place, handed out two frames after its page left; and one while an older page was there.
    std::map<int, uint64_t> left;
    for (PoolEvent& e : early) {
        if (e.kind == PoolEvent::Kind::left_tree) left[e.place] = e.frame;
        if (e.kind == PoolEvent::Kind::taken && left.contains(e.place)) {
            e.frame = left[e.place] + 2;
            break;
        }
    }
    EXPECT_EQ(pool_fault(early), "handed out within three frames");
    for (PoolEvent& e : unordered)
        if (e.kind == PoolEvent::Kind::taken && e.oldest != UINT64_MAX) {
            e.last_requested = e.oldest + 1;
            break;
        }
    EXPECT_EQ(pool_fault(unordered), "an older page was left");
}

TEST(PagePool, WaitsAndAgesAreSettings) {
    PagePool pool(3, {.age_frames = 7, .first_retry_frames = 2, .last_retry_frames = 4});
    const int place = pool.take(page(1), 10);
    pool.promote(11, [](int) {});
    EXPECT_TRUE(pool.retirable(16).empty());
    EXPECT_EQ(pool.retirable(17), std::vector<int>{place});
    pool.mark_low_res(place, 4, 10);
    EXPECT_EQ(pool.place(place).retry_frame, 12u);
    pool.mark_low_res(place, 4, 12);
    EXPECT_EQ(pool.place(place).retry_frame, 16u);
    pool.mark_low_res(place, 4, 16);
    EXPECT_EQ(pool.place(place).retry_frame, 20u) << "at most the last";
}

}  // namespace
