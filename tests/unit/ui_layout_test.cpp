#include "ui/layout.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/unit/ui_demo.h"

namespace loam::ui {
namespace {

// Children follow one another with the gap, never overlap, never leave the room, and fill it when one is
// flexible.
TEST(UiLayout, RandomRowsKeepTheirProperties) {
    std::mt19937 random(1);
    const auto number = [&](float high) { return std::uniform_real_distribution<float>(0, high)(random); };
    for (int round = 0; round < 5000; ++round) {
        std::vector<Size> sizes;
        std::vector<float> wanted;
        bool flexible = false;
        float flex_min = 0, rigid = 0;
        const float scale = round % 2 ? 1.0f : 1.5f;
        for (int i = 0, n = 1 + int(number(6)); i < n; ++i) {
            const int kind = int(number(2.999f));
            sizes.push_back(kind == 0   ? fixed(number(200))
                            : kind == 1 ? content()
                                        : flex(0.1f + number(3), number(60)));
            wanted.push_back(std::ceil(number(150)));
            flexible |= kind == 2;
            if (kind == 2) flex_min += sizes.back().min * scale + 1;
            if (kind == 0) rigid += sizes.back().value * scale + 1;
            if (kind == 1) rigid += wanted.back();
        }
        const float available = std::floor(number(900)), gap = 8;
        const auto out = solve(
            {.sizes = sizes, .content_px = wanted, .available_px = available, .gap_px = gap, .scale = scale});
        ASSERT_EQ(out.size(), sizes.size());
        float at = 0;
        for (const Extent& e : out) {
            ASSERT_FLOAT_EQ(e.start, at);
            ASSERT_GE(e.length, 0);
            ASSERT_FLOAT_EQ(e.length, std::round(e.length));
            at = e.start + e.length + gap;
        }
        const float gaps = gap * float(sizes.size() - 1), end = at - gap;
        ASSERT_LE(end, std::max(available, gaps) + 0.01f);
        if (flexible && rigid + flex_min + gaps <= available) {
            ASSERT_NEAR(end, available, 0.01f);
        }
    }
}

TEST(UiLayout, WeightsShareInProportion) {
    const Size sizes[] = {flex(1), flex(3), fixed(100)};
    const auto out = solve({.sizes = sizes, .available_px = 500});
    EXPECT_FLOAT_EQ(out[0].length, 100);
    EXPECT_FLOAT_EQ(out[1].length, 300);
    EXPECT_FLOAT_EQ(out[2].length, 100);
}

TEST(UiLayout, AShareBelowTheMinimumIsRaisedAndTheRestShared) {
    const Size sizes[] = {flex(1, 200), flex(1), flex(1)};
    const auto out = solve({.sizes = sizes, .available_px = 400});
    EXPECT_FLOAT_EQ(out[0].length, 200);
    EXPECT_FLOAT_EQ(out[1].length, 100);
    EXPECT_FLOAT_EQ(out[2].length, 100);
}

TEST(UiLayout, DockedPanelsTileTheWindow) {
    Rect area{0, 0, 1280, 800};
    const Rect top = cut(area, Edge::top, 36), side = cut(area, Edge::right, 320),
               bar = cut(area, Edge::left, 44);
    EXPECT_EQ(top, (Rect{0, 0, 1280, 36}));
    EXPECT_EQ(side, (Rect{960, 36, 320, 764}));
    EXPECT_EQ(bar, (Rect{0, 36, 44, 764}));
    EXPECT_EQ(area, (Rect{44, 36, 916, 764}));
    EXPECT_EQ(cut(area, Edge::bottom, 5000).h, 764) << "a strip is never larger than the area";
    EXPECT_TRUE(area.empty());
}

TEST(UiLayout, AContentCellLearnsItsWidthWithinTheSettlingFrames) {
    Harness h;
    Rect first, second;
    const FrameOutput& out = h.frame({}, [&](Ui& ui) {
        auto row = ui.row({content(), flex()});
        first = ui.allocate({123, 20});
        second = ui.allocate({10, 20});
    });
    EXPECT_FALSE(out.redraw);
    EXPECT_FLOAT_EQ(first.w, 123);
    EXPECT_FLOAT_EQ(second.right(), 1280);
}

TEST(UiLayout, ASpringEndsAtTheEdge) {
    Harness h;
    Rect last;
    h.frame({}, [&](Ui& ui) {
        auto flow = ui.flow();
        ui.allocate({50, 20});
        ui.spring();
        ui.allocate({70, 20});
        last = ui.allocate({30, 20});
    });
    EXPECT_FLOAT_EQ(last.right(), 1280);
}

}  // namespace
}  // namespace loam::ui
