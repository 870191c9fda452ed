// The composition manager: what a frame composes first, and how much. Each property is looked at by a function that says what
// is wrong with a plan; plans that are wrong on purpose must be found.
#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "runtime/texture/compose_plan.h"

namespace {

using namespace loam;

std::vector<DirtyPage> random_dirt(std::mt19937& random, int count) {
    std::vector<DirtyPage> pages;
    for (int i = 0; i < count; ++i)
        pages.push_back({.place = i,
                         .texels = 64 + int64_t(random() % uint32_t(ComposeBudget::kPage)),
                         .shown = random() % 3 == 0 ? uint32_t(1 + random() % 500) : 0u,
                         .wanted = random() % 2 == 0,
                         .distance_m = double(random() % 1000)});
    return pages;
}

// Empty: what is in view comes before everything else, and as much of it as the lane takes is composed.
std::string dirt_fault(const std::vector<DirtyPage>& ordered, size_t count) {
    bool unseen = false;
    for (const DirtyPage& p : ordered) {
        if (p.shown == 0) unseen = true;
        if (p.shown > 0 && unseen) return "a page in view waits behind one that is not";
    }
    int64_t texels = 0;
    size_t must = 0;
    for (; must < ordered.size() && ordered[must].shown > 0; ++must)
        if ((texels += ordered[must].texels) > kShownDirtTexels && must > 0) break;
    if (count < must) return "dirt in view was left though the lane has room";
    for (size_t i = 1; i < ordered.size(); ++i)
        if (ordered[i - 1].shown == 0 && ordered[i].shown == 0 && ordered[i].wanted && !ordered[i - 1].wanted)
            return "a page that is wanted waits behind one that nobody asks for";
    return "";
}

TEST(ComposePlan, DirtInViewIsFirstWhateverWaitsAndWhateverTheBudget) {
    std::mt19937 random(5);
    int with_both = 0;
    for (int round = 0; round < 500; ++round) {
        std::vector<DirtyPage> pages = random_dirt(random, 1 + int(random() % 60));
        order_dirty(pages);
        const int64_t budget = int64_t(random() % 5) * ComposeBudget::kPage / 2;
        EXPECT_EQ(dirt_fault(pages, dirt_that_fits(pages, budget)), "");
        with_both += pages.front().shown > 0 && pages.back().shown == 0;
    }
    EXPECT_GT(with_both, 100);
}

TEST(ComposePlan, AWrongOrderOrATooShortLaneIsFound) {
    std::mt19937 random(5);
    int found_order = 0, found_lane = 0;
    for (int round = 0; round < 50; ++round) {
        std::vector<DirtyPage> pages = random_dirt(random, 30);
        order_dirty(pages);
        found_lane += pages.front().shown > 0 && dirt_fault(pages, 0) != "";
        std::reverse(pages.begin(), pages.end());
        found_order += dirt_fault(pages, pages.size()) != "";
    }
    EXPECT_GT(found_order, 45);
    EXPECT_GT(found_lane, 45);
}

TEST(ComposePlan, DirtOutOfViewKeepsToTheBudget) {
    std::mt19937 random(8);
    for (int round = 0; round < 200; ++round) {
        std::vector<DirtyPage> pages = random_dirt(random, 40);
        for (DirtyPage& p : pages) p.shown = 0;
        order_dirty(pages);
        const int64_t budget = ComposeBudget::kPage * int64_t(1 + random() % 4);
        const size_t count = dirt_that_fits(pages, budget);
        int64_t texels = 0;
        for (size_t i = 0; i < count; ++i) texels += pages[i].texels;
        EXPECT_GE(count, 1u);
        EXPECT_TRUE(texels <= budget || count == 1);
        if (count < pages.size()) {
            EXPECT_GT(texels + pages[count].texels, budget) << "there was room for more";
        }
    }
    EXPECT_EQ(dirt_that_fits({}, ComposeBudget::kPage), 0u);
}

TEST(ComposePlan, LowResPagesThatNeedItMostAreFirst) {
    std::vector<LowResPage> pages = {{.place = 0, .popularity = 100, .levels_short = 1},
                                     {.place = 1, .popularity = 100, .levels_short = 3},
                                     {.place = 2, .popularity = 900, .levels_short = 1},
                                     {.place = 3, .popularity = 100, .levels_short = 1, .final = true}};
    order_low_res(pages);
    const int order[] = {1, 2, 3, 0};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(pages[size_t(i)].place, order[i]);
}

TEST(ComposePlan, ABudgetInMillisecondsIsPagesByTheirPrice) {
    const auto pages = [](double ms, double page_ms, int64_t dirt = 0) {
        return page_allowance({.pages = 2, .ms = ms, .page_ms = page_ms}, dirt, 1);
    };
    EXPECT_EQ(pages(0, 5), 2);
    EXPECT_EQ(pages(20, 5), 4);
    EXPECT_EQ(pages(20, 0.5), 40);
    EXPECT_EQ(pages(20, 5, 2 * ComposeBudget::kPage), 2) << "dirt has taken half of it";
    EXPECT_EQ(pages(2, 5), 1) << "something is always made";
    EXPECT_EQ(page_allowance({.ms = 2, .page_ms = 5}, ComposeBudget::kPage, 1), 0);
    EXPECT_EQ(page_allowance({.ms = 2, .page_ms = 5}, ComposeBudget::kPage, 2), 1) << "every other frame";
    // Frames that are waited for: the smaller of the two.
    EXPECT_EQ(page_allowance({.pages = 12, .fit_texels = 3 * ComposeBudget::kPage, .waited_for = true}, 0, 1), 3);
    EXPECT_EQ(page_allowance({.pages = 0, .fit_texels = 3 * ComposeBudget::kPage, .waited_for = true}, 0, 2), 0);
}

TEST(ComposePrice, FindsWhatAPageCostsAmongNoise) {
    for (const double page_ms : {0.1, 1.0, 6.5}) {
        std::mt19937 random(3);
        std::normal_distribution<double> noise(0, 0.5);
        ComposePrice price;
        EXPECT_EQ(price.page_ms(), ComposePrice::kUnknown_ms);
        for (int i = 0; i < 200; ++i) {
            const int pages = int(random() % 5);
            const double stall = i % 50 == 49 ? 400 : 0;
            price.frame_took(15 + page_ms * pages + noise(random) + stall, pages * ComposeBudget::kPage);
        }
        EXPECT_NEAR(price.page_ms(), page_ms, 0.12 + 0.1 * page_ms);
        const double known = price.page_ms();
        for (int i = 0; i < 500; ++i) price.frame_took(15 + noise(random), 0);
        EXPECT_NEAR(price.page_ms(), known, 0.3 + 0.3 * known) << "nothing varies: what is known is kept";
    }
}

} // namespace
