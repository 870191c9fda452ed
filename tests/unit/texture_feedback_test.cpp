// What the analyser makes of feedback values.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "runtime/texture/feedback.h"

namespace {

using namespace loam;

constexpr TextureLayout kLayout{.default_log2_width = 6, .default_log2_page = 0};

FeedbackImages images() {
    FeedbackImages i;
    i.valid[0] = true;
    i.log2_width[0] = 6;
    i.log2_width[3] = 6;
    i.image[3] = {true, 5, 7};
    i.valid[3] = true;
    return i;
}

uint32_t value(int mip, int id, int x, int y) {
    return uint32_t(mip) << 24 | uint32_t(id) << 16 | uint32_t(y) << 8 | uint32_t(x);
}

FeedbackResult analyse(
    std::vector<uint32_t> values, uint32_t capacity = 400,
    std::function<bool(const PageId&)> visible = [](const PageId&) { return false; }, double speed_m_s = 0,
    bool exact = false, uint32_t kept = 0) {
    static const FeedbackImages known = images();
    values.resize(std::max<size_t>(values.size(), 240 * 136), kNoTerrain);  // three cells are the threshold
    return analyse_feedback({.values = values,
                             .images = &known,
                             .layout = kLayout,
                             .capacity_pages = capacity,
                             .kept_pages = kept,
                             .speed_m_s = speed_m_s,
                             .exact = exact,
                             .is_visible = std::move(visible)});
}

const PageRequest* find(const FeedbackResult& r, const PageId& page) {
    const auto it = std::find_if(r.requests.begin(), r.requests.end(),
                                 [&](const PageRequest& q) { return q.page == page; });
    return it == r.requests.end() ? nullptr : &*it;
}

TEST(Feedback, SkyAsksForNothing) {
    const auto r = analyse(std::vector<uint32_t>(100, kNoTerrain));
    EXPECT_TRUE(r.requests.empty());
    EXPECT_EQ(r.terrain_cells, 0u);
}

TEST(Feedback, ChildrenCountForTheirParents) {
    std::vector<uint32_t> values(10, value(0, 3, 12, 20));
    values.insert(values.end(), 5, value(0, 3, 13, 20));
    const auto r = analyse(values);
    const ImageId image{true, 5, 7};
    ASSERT_NE(find(r, {image, 6, 12, 20}), nullptr);
    EXPECT_EQ(find(r, {image, 6, 12, 20})->popularity, 10u);
    EXPECT_EQ(find(r, {image, 5, 6, 10})->popularity, 15u);
    EXPECT_GT(find(r, {image, 0, 0, 0})->popularity, 15u);
    EXPECT_EQ(r.requests.size(), 8u);  // seven depths and one sibling
}

TEST(Feedback, ParentsComeBeforeChildrenAndPopularityFalls) {
    std::mt19937 random(5);
    std::vector<uint32_t> values;
    for (int i = 0; i < 5000; ++i)
        values.push_back(
            value(int(random() % 4), random() % 2 ? 3 : 0, int(random() % 8), int(random() % 8)));
    const auto r = analyse(values, 100'000);
    std::set<std::tuple<bool, int, int, int>> seen;
    for (size_t i = 0; i < r.requests.size(); ++i) {
        const PageId& p = r.requests[i].page;
        EXPECT_LE(r.requests[i].popularity, r.requests[i > 0 ? i - 1 : 0].popularity);
        EXPECT_TRUE(p.depth == 0 || seen.contains({p.image.live, p.depth - 1, p.x / 2, p.y / 2}));
        seen.insert({p.image.live, p.depth, p.x, p.y});
    }
}

TEST(Feedback, FewCellsAreNoiseUnlessThePageIsVisible) {
    const std::vector<uint32_t> values(2, value(0, 0, 9, 9));
    EXPECT_EQ(find(analyse(values), {{}, 6, 9, 9}), nullptr);
    EXPECT_NE(find(analyse(values), {{}, 0, 0, 0}), nullptr) << "roots are always wanted";
    const auto rescued = analyse(values, 400, [](const PageId& p) { return p.depth == 6; });
    EXPECT_NE(find(rescued, {{}, 6, 9, 9}), nullptr);
}

TEST(Feedback, AtMostAThirdOfTheCache) {
    std::vector<uint32_t> values;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) values.insert(values.end(), 4, value(0, 0, x, y));
    EXPECT_EQ(analyse(values, 90).requests.size(), 30u);
}

// Nothing else will be wanted: but for what is kept for others, a still picture may have every page.
TEST(Feedback, AStillPictureMayHaveAllButWhatIsKept) {
    std::vector<uint32_t> values;
    for (int i = 0; i < 256; ++i) values.insert(values.end(), 10, value(0, 0, i & 15, i >> 4));
    const auto none = [](const PageId&) { return false; };
    EXPECT_EQ(analyse(values, 300, none, 0, true, 60).requests.size(), 240u);
    EXPECT_EQ(analyse(values, 300, none, 0, true, 250).requests.size(), 100u);  // never less than a third
    EXPECT_EQ(analyse(values, 300, none, 0, true, 400).requests.size(), 100u);
    EXPECT_EQ(analyse(values, 300, none, 0, false, 60).requests.size(), 100u);
}

TEST(Feedback, ValuesThatMeanNoPageAreIgnored) {
    const std::vector<uint32_t> values = {value(9, 0, 0, 0),  value(9, 0, 0, 0),  value(9, 0, 0, 0),
                                          value(0, 77, 1, 1), value(0, 77, 1, 1), value(0, 77, 1, 1),
                                          value(5, 0, 60, 0), value(5, 0, 60, 0), value(5, 0, 60, 0)};
    EXPECT_TRUE(analyse(values).requests.empty());
}

TEST(Feedback, EveryCellCountsWhenThePictureIsStill) {
    const std::vector<uint32_t> values(1, value(0, 0, 9, 9));
    EXPECT_EQ(find(analyse(values), {{}, 6, 9, 9}), nullptr);
    EXPECT_NE(find(analyse(
                       values, 400, [](const PageId&) { return false; }, 0, true),
                   {{}, 6, 9, 9}),
              nullptr);
}

TEST(Feedback, TheSpeedOfTheCameraSpeaksAgainstFinePages) {
    // A finest page of the sector is 1 m wide, of the default image 64 m.
    std::vector<uint32_t> values(100, value(0, 3, 12, 20));
    values.insert(values.end(), 60, value(0, 0, 9, 12));
    const PageId fine{{true, 5, 7}, 6, 12, 20}, coarse{{}, 6, 9, 12};
    const auto none = [](const PageId&) { return false; };
    const auto still = analyse(values), moving = analyse(values, 400, none, 40);  // 10 m in the horizon
    EXPECT_EQ(find(still, fine)->popularity, 100u);
    EXPECT_EQ(find(moving, fine)->popularity, 10u);
    EXPECT_EQ(find(moving, coarse)->popularity, 60u);
    // Parents still come before their children.
    for (size_t i = 1; i < moving.requests.size(); ++i)
        EXPECT_LE(moving.requests[i].popularity, moving.requests[i - 1].popularity);
    // Fast enough, it is not worth a page: but for one that is visible.
    EXPECT_EQ(find(analyse(values, 400, none, 400), fine), nullptr);
    EXPECT_NE(find(analyse(
                       values, 400, [](const PageId&) { return true; }, 400),
                   fine),
              nullptr);
}

TEST(Feedback, TellsHowFarThePictureIsFromWhatItWants) {
    std::vector<uint32_t> values(7, value(0, 3, 12, 20));
    values.insert(values.end(), 4, value(0, 3, 12, 20) | 2u << kFeedbackCoarserShift);
    values.insert(values.end(), 2, value(1, 0, 3, 4) | 7u << kFeedbackCoarserShift);
    const auto r = analyse(values);
    EXPECT_EQ(r.coarser, (std::array<uint32_t, 8>{7, 0, 4, 0, 0, 0, 0, 2}));
    EXPECT_EQ(r.terrain_cells, 13u);
    EXPECT_EQ(find(r, {{true, 5, 7}, 6, 12, 20})->cells, 11u) << "the same page";
}

TEST(Feedback, AValueIsReadAsTheImageWasWhenItWasWritten) {
    FeedbackImages known = images();
    known.log2_width[3] = 8;
    const std::vector<uint32_t> values(5, value(1, 3, 100, 127));
    const auto r = analyse_feedback({.values = values,
                                     .images = &known,
                                     .layout = kLayout,
                                     .capacity_pages = 400,
                                     .is_visible = [](const PageId&) { return false; }});
    EXPECT_NE(find(r, {{true, 5, 7}, 7, 100, 127}), nullptr);
}

// A plain counting of the same thing.
TEST(Feedback, AgreesWithPlainCounting) {
    std::mt19937 random(9);
    for (int round = 0; round < 20; ++round) {
        std::vector<uint32_t> values;
        std::map<std::tuple<bool, int, int, int>, uint32_t> plain;
        for (int i = 0; i < 3000; ++i) {
            const int id = random() % 2 ? 3 : 0, mip = int(random() % 7), side = 64 >> mip;
            int x = int(random() % uint32_t(side)), y = int(random() % uint32_t(side));
            const uint32_t run = 1 + random() % 4;
            values.insert(values.end(), run,
                          value(mip, id, x, y) | uint32_t(random() % 3) << kFeedbackCoarserShift);
            for (int depth = 6 - mip; depth >= 0; --depth, x >>= 1, y >>= 1)
                plain[{id == 3, depth, x, y}] += run;
        }
        const auto r = analyse(
            values, 1'000'000, [](const PageId&) { return false; }, 0, true);
        ASSERT_EQ(r.requests.size(), plain.size());
        for (const PageRequest& q : r.requests) {
            const uint32_t counted = plain.at({q.page.image.live, q.page.depth, q.page.x, q.page.y});
            EXPECT_EQ(q.page.depth == 0 ? q.popularity & 0xffffff : q.popularity, counted);
        }
    }
}

TEST(Feedback, TheJitterVisitsEveryPlaceOfACell) {
    std::set<std::pair<int, int>> places;
    for (uint64_t frame = 100; frame < 164; ++frame) {
        const FeedbackGrid grid = feedback_grid(FeedbackCells::eighth, {963, 540}, frame);
        EXPECT_EQ(grid.cells, glm::ivec2(121, 68));
        places.insert({int(grid.jitter.x * 8), int(grid.jitter.y * 8)});
    }
    EXPECT_EQ(places.size(), 64u);
    EXPECT_EQ(feedback_grid(FeedbackCells::grid, {960, 540}, 5).cells, glm::ivec2(240, 136));
    const FeedbackGrid every = feedback_grid(FeedbackCells::every_pixel, {960, 540}, 5);
    EXPECT_EQ(every.cells, glm::ivec2(960, 540));
    const FeedbackGrid large = feedback_grid(FeedbackCells::every_pixel, {3840, 2160}, 5);
    EXPECT_LE(large.cells.x * large.cells.y, kEveryPixelLimit);
}

}  // namespace
