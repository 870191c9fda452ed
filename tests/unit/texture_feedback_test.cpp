// What the analyser makes of feedback values.
#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "runtime/texture/feedback.h"

namespace {

using namespace loam;

constexpr TextureLayout kLayout{.default_log2_width = 6, .default_log2_page = 0, .sector_log2_width = 6};

FeedbackImages images() {
    FeedbackImages i;
    i.valid[0] = true;
    i.image[3] = {true, 5, 7};
    i.valid[3] = true;
    return i;
}

uint32_t value(int mip, int id, int x, int y) {
    return uint32_t(mip) << 24 | uint32_t(id) << 16 | uint32_t(y) << 8 | uint32_t(x);
}

FeedbackResult analyse(
    const std::vector<uint32_t>& values, uint32_t capacity = 400, uint32_t threshold = 3,
    std::function<bool(const PageId&)> visible = [](const PageId&) { return false; }) {
    static const FeedbackImages known = images();
    return analyse_feedback({.values = values,
                             .images = &known,
                             .layout = kLayout,
                             .capacity_pages = capacity,
                             .threshold = threshold,
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
    const auto rescued = analyse(values, 400, 3, [](const PageId& p) { return p.depth == 6; });
    EXPECT_NE(find(rescued, {{}, 6, 9, 9}), nullptr);
}

TEST(Feedback, AtMostAThirdOfTheCache) {
    std::vector<uint32_t> values;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) values.insert(values.end(), 4, value(0, 0, x, y));
    EXPECT_EQ(analyse(values, 90).requests.size(), 30u);
}

TEST(Feedback, ValuesThatMeanNoPageAreIgnored) {
    const std::vector<uint32_t> values = {value(9, 0, 0, 0),  value(9, 0, 0, 0),  value(9, 0, 0, 0),
                                          value(0, 77, 1, 1), value(0, 77, 1, 1), value(0, 77, 1, 1),
                                          value(5, 0, 60, 0), value(5, 0, 60, 0), value(5, 0, 60, 0)};
    EXPECT_TRUE(analyse(values).requests.empty());
}

TEST(Feedback, TooCoarseDefaultPagesAskForSectors) {
    const std::vector<uint32_t> values(4, value(0, 0, 9, 12) | kFeedbackFinerBit);
    const auto r = analyse(values);
    ASSERT_EQ(r.wants_finer.size(), 1u);
    EXPECT_EQ(r.wants_finer[0], (PageId{{}, 6, 9, 12}));
    EXPECT_TRUE(
        analyse(std::vector<uint32_t>(4, value(0, 3, 9, 12) | kFeedbackFinerBit)).wants_finer.empty());
}

}  // namespace
