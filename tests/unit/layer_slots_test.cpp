#include "runtime/texture/layer_slots.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace loam {
namespace {

using List = std::vector<uint32_t>;

// A frame whose loads come at once; returns those that found no slot.
List serve(LayerSlots& slots, const List& load) {
    List waiting;
    for (const uint32_t layer : load) slots.begin_load(layer);
    for (const uint32_t layer : load)
        if (slots.place(layer) < 0) waiting.push_back(layer);
    return waiting;
}

TEST(layer_slots, most_wanted_pages_get_all_of_their_layers) {
    LayerSlots slots(10, 4);
    slots.want(List{0, 1, 2}, 1);
    slots.want(List{2, 3}, 5);
    slots.want(List{4, 5, 6}, 3);
    // The second's two; the third's three do not fit beside them; the first's two more do.
    EXPECT_EQ(slots.take_wishes(), (List{2, 3, 0, 1}));
    EXPECT_TRUE(slots.take_wishes().empty()) << "wishes are of one frame";
}

TEST(layer_slots, what_was_not_used_for_longest_goes) {
    LayerSlots slots(6, 3);
    slots.want(List{0, 1, 2}, 1);
    EXPECT_TRUE(serve(slots, slots.take_wishes()).empty());
    slots.want(List{0, 2}, 1);
    EXPECT_TRUE(slots.take_wishes().empty());
    slots.want(List{3}, 1);
    EXPECT_TRUE(serve(slots, slots.take_wishes()).empty());
    EXPECT_FALSE(slots.all_resident(List{1}));
    EXPECT_TRUE(slots.all_resident(List{0, 2, 3}));
    // What is wanted stays, however long ago it was used.
    slots.want(List{0, 2, 3}, 2);
    slots.want(List{4}, 1);
    EXPECT_TRUE(slots.take_wishes().empty());
    slots.begin_load(5);
    EXPECT_EQ(slots.place(5), -1) << "a layer that comes late finds all slots wanted";
}

// Their copies into the slot would have no order.
TEST(layer_slots, no_slot_is_given_twice_in_a_round) {
    LayerSlots slots(6, 2);
    slots.want(List{0, 1}, 1);
    EXPECT_TRUE(serve(slots, slots.take_wishes()).empty());
    slots.want(List{0}, 1);
    EXPECT_TRUE(slots.take_wishes().empty());
    for (const uint32_t late : {2u, 3u}) slots.begin_load(late);  // wanted by nobody any more
    EXPECT_GE(slots.place(2), 0);
    EXPECT_EQ(slots.place(3), -1);
    EXPECT_TRUE(slots.take_wishes().empty());
    EXPECT_GE(slots.place(3), 0) << "in the next round";
}

TEST(layer_slots, ready_is_as_good_as_it_gets) {
    LayerSlots slots(6, 2);
    EXPECT_FALSE(slots.ready(List{0, 1}));
    EXPECT_TRUE(slots.ready(List{0, 1, 2})) << "more than there are slots";
    EXPECT_TRUE(slots.ready(List{}));
    slots.want(List{0, 1}, 1);
    for (const uint32_t layer : slots.take_wishes()) slots.begin_load(layer);
    slots.fail(1);
    EXPECT_TRUE(slots.ready(List{0, 1})) << "one never comes";
    EXPECT_FALSE(slots.all_resident(List{0, 1}));
    slots.want(List{1}, 1);
    EXPECT_TRUE(slots.take_wishes().empty()) << "it is not asked for again";
}

// Pages that each fit: whatever they share and in whatever order loads come, all are composed in the end, and
// no two layers are ever in one slot.
TEST(layer_slots, random_pages_all_get_their_turn) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        const int layers = 4 + int(random() % 40), count = 1 + int(random() % 8);
        LayerSlots slots(layers, count);
        std::vector<List> pages(1 + random() % 30);
        for (List& page : pages)
            for (int i = 0; i < count; ++i)
                if (const uint32_t layer = random() % uint32_t(layers);
                    std::find(page.begin(), page.end(), layer) == page.end())
                    page.push_back(layer);
        std::vector<uint32_t> on_the_way;
        int frames = 0;
        while (!pages.empty()) {
            ASSERT_LT(++frames, 2000);
            for (const List& page : pages) slots.want(page, float(random() % 5));
            for (const uint32_t layer : slots.take_wishes()) {
                if (on_the_way.size() >= 3) break;
                slots.begin_load(layer);
                on_the_way.push_back(layer);
            }
            std::shuffle(on_the_way.begin(), on_the_way.end(), random);
            std::erase_if(on_the_way,
                          [&](uint32_t layer) { return random() % 2 == 0 && slots.place(layer) >= 0; });
            std::set<int> taken;
            for (uint32_t i = 0; i < uint32_t(layers); ++i)
                if (slots.slot_of(i) >= 0)
                    ASSERT_TRUE(slots.slot_of(i) < count && taken.insert(slots.slot_of(i)).second);
            const auto done = std::find_if(pages.begin(), pages.end(),
                                           [&](const List& page) { return slots.all_resident(page); });
            if (done == pages.end()) continue;  // one a frame
            pages.erase(done);
        }
    }
}

}  // namespace
}  // namespace loam
