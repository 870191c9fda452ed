#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/ui_demo.h"

namespace loam::ui {
namespace {

constexpr Mods kCtrl{.ctrl = true}, kShift{.shift = true};

std::vector<Event> typed(std::string_view text) {
    std::vector<Event> events;
    for (const char c : text) events.push_back(Event::character(char32_t(c)));
    return events;
}

TEST(UiWidgets, IdsAreStableAndDependOnTheirScope) {
    Harness h;
    Id first = 0, again = 0, inner = 0;
    h.frame({}, [&](Ui& ui) {
        first = ui.make_id("a");
        ui.push_id("scope");
        inner = ui.make_id("a");
        ui.pop_id();
    });
    h.frame({}, [&](Ui& ui) { again = ui.make_id("a"); });
    EXPECT_EQ(first, again);
    EXPECT_NE(first, inner);
    EXPECT_EQ(visible_label("Name##7"), "Name");
}

TEST(UiWidgets, SharedIdsAreCounted) {
    Harness h;
    const auto& out = h.frame({}, [](Ui& ui) {
        button(ui, "Same");
        button(ui, "Same");
        button(ui, "Same##2");
    });
    EXPECT_EQ(out.duplicate_ids, 1);
}

TEST(UiWidgets, AButtonClicksOnReleaseInsideAndNotOutside) {
    Harness h;
    int clicks = 0;
    const auto build = [&](Ui& ui) { clicks += button(ui, "Go"); };
    h.frame({Event::move({20, 10}), Event::press({20, 10})}, build);
    EXPECT_EQ(clicks, 0);
    EXPECT_TRUE(h.last.captured);
    h.frame({Event::release({20, 10})}, build);
    EXPECT_EQ(clicks, 1);
    h.frame({Event::press({20, 10}), Event::move({20, 400}), Event::release({20, 400})}, build);
    EXPECT_EQ(clicks, 1) << "leaving cancels";
    EXPECT_FALSE(h.last.captured);
    h.frame({Event::press({20, 400}), Event::move({20, 10}), Event::release({20, 10})}, build);
    EXPECT_EQ(clicks, 1) << "a press elsewhere does not count";
    // Press and release in one batch, twice: none is lost.
    h.frame(
        {Event::press({20, 10}), Event::release({20, 10}), Event::press({20, 10}), Event::release({20, 10})},
        build);
    EXPECT_EQ(clicks, 3);
}

TEST(UiWidgets, ADisabledButtonDoesNothing) {
    Harness h;
    int clicks = 0;
    const auto build = [&](Ui& ui) {
        ui.push_disabled(true);
        clicks += button(ui, "Go");
        ui.pop_disabled();
    };
    h.click({20, 10}, build);
    h.frame({Event::key_down(Key::tab), Event::key_down(Key::space)}, build);
    EXPECT_EQ(clicks, 0);
}

TEST(UiWidgets, APressIsCapturedUntilItsRelease) {
    Harness h;
    bool other_hovered = false, held = false;
    const auto build = [&](Ui& ui) {
        held = ui.interact(ui.make_id("a"), {0, 0, 100, 100}, Sense::drag).held;
        other_hovered = ui.interact(ui.make_id("b"), {200, 0, 100, 100}, Sense::click).hovered;
    };
    h.frame({Event::press({50, 50}), Event::move({250, 50})}, build);
    EXPECT_TRUE(held);
    EXPECT_FALSE(other_hovered);
    h.frame({Event::blur()}, build);
    EXPECT_FALSE(held);
    EXPECT_FALSE(h.last.captured);
}

TEST(UiWidgets, CaptureEndsWhenTheWidgetVanishes) {
    Harness h;
    h.frame({Event::press({20, 10})}, [](Ui& ui) { button(ui, "Go"); });
    EXPECT_TRUE(h.last.captured);
    h.frame({}, [](Ui&) {});
    EXPECT_FALSE(h.last.captured);
}

TEST(UiWidgets, TabWalksForwardsAndBackAndSpaceActivates) {
    Harness h;
    std::string log;
    const auto build = [&](Ui& ui) {
        for (const char* name : {"a", "b", "c"})
            if (button(ui, name)) log += name;
    };
    const auto tab = [&](Mods m = {}) {
        h.frame({Event::key_down(Key::tab, m), Event::key_down(Key::space)}, build);
    };
    tab(), tab(), tab(), tab();
    EXPECT_EQ(log, "abca");
    log.clear();
    tab(kShift), tab(kShift);
    EXPECT_EQ(log, "cb");
    h.frame({Event::key_down(Key::enter)}, build);
    EXPECT_EQ(log, "cbb");
}

TEST(UiSlider, Arithmetic) {
    const SliderDesc d{.min = -10, .max = 25, .step = 10};
    EXPECT_EQ(clamped(std::nan(""), d), -10);
    EXPECT_EQ(clamped(1e300, d), 20) << "the range is not a multiple of the step";
    EXPECT_EQ(clamped(-std::numeric_limits<double>::infinity(), d), -10);
    const SliderDesc log{.min = 0.5, .max = 200, .logarithmic = true};
    for (double f = 0; f <= 1; f += 0.01) EXPECT_NEAR(slider_fraction(slider_value(f, log), log), f, 1e-9);
    EXPECT_EQ(parse_number(" 1,5 m ", "m"), 1.5);
    EXPECT_EQ(parse_number("+3"), 3.0);
    for (const char* bad : {"", "nan", "inf", "1e999", "12x", "1.2.3", "--1", "m"})
        EXPECT_FALSE(parse_number(bad)) << bad;
    EXPECT_EQ(format_number(-0.0001, 2), "0.00");
}

struct SliderFixture : testing::Test {
    Harness h;
    double value = 0.5;
    int changes = 0, ends = 0;
    SliderDesc desc{};
    void build(Ui& ui) {
        const Edit e = slider(ui, "##s", value, desc);
        changes += e.changed;
        ends += e.finished;
    }
    void frame(std::vector<Event> events) {
        h.frame(std::span<const Event>(events), [this](Ui& ui) { build(ui); });
    }
    void double_click() {
        frame({Event::press({50, 10}), Event::release({50, 10}), Event::press({50, 10}),
               Event::release({50, 10})});
    }
};

TEST_F(SliderFixture, ADragChangesAndShiftIsTenTimesFiner) {
    frame({Event::press({500, 10})});
    EXPECT_EQ(changes, 0) << "a press alone changes nothing";
    frame({Event::move({628, 10})});
    EXPECT_NEAR(value, 0.6, 1e-6);
    EXPECT_EQ(ends, 0);
    frame({Event::release({628, 10})});
    EXPECT_EQ(ends, 1);
    h.time_s += 5;
    frame({Event::press({500, 10}, MouseButton::left, kShift), Event::move({628, 10}),
           Event::release({628, 10})});
    EXPECT_NEAR(value, 0.61, 1e-6);
    h.time_s += 5;
    frame({Event::press({500, 10}), Event::move({99999, 10}), Event::release({99999, 10})});
    EXPECT_EQ(value, 1.0);
}

TEST_F(SliderFixture, EscapeTakesADragBack) {
    frame({Event::press({500, 10}), Event::move({900, 10})});
    EXPECT_GT(value, 0.7);
    frame({Event::key_down(Key::escape)});
    EXPECT_EQ(value, 0.5);
    EXPECT_FALSE(h.last.captured);
}

TEST_F(SliderFixture, ANumberCanBeTypedIsClampedAndGarbageRefused) {
    double_click();
    frame(typed("0.75"));
    EXPECT_EQ(value, 0.5) << "not before Enter";
    frame({Event::key_down(Key::enter)});
    EXPECT_EQ(value, 0.75);
    h.time_s += 5;
    double_click();
    frame(typed("900"));
    frame({Event::key_down(Key::enter)});
    EXPECT_EQ(value, 1.0);
    h.time_s += 5;
    for (const char* bad : {"nan", "garbage", "inf", ""}) {
        double_click();
        frame({Event::key_down(Key::a, kCtrl), Event::key_down(Key::del)});
        frame(typed(bad));
        frame({Event::key_down(Key::enter)});
        EXPECT_EQ(value, 1.0) << bad;
        frame({Event::key_down(Key::escape)});
        EXPECT_EQ(value, 1.0) << bad;
        h.time_s += 5;
    }
}

TEST_F(SliderFixture, ArrowsMoveAndEnterTypes) {
    frame({Event::key_down(Key::tab), Event::key_down(Key::right)});
    EXPECT_NEAR(value, 0.51, 1e-9);
    frame({Event::key_down(Key::home)});
    EXPECT_EQ(value, 0);
    frame({Event::key_down(Key::enter)});
    frame(typed("0.3"));
    EXPECT_TRUE(h.last.wants_keyboard);
    frame({Event::key_down(Key::enter)});
    EXPECT_EQ(value, 0.3);
}

TEST_F(SliderFixture, AValueFromOutsideThatIsNoNumberIsPutRight) {
    value = std::nan("");
    frame({});
    EXPECT_EQ(value, 0);
    value = 7;
    frame({});
    EXPECT_EQ(value, 1);
}

struct FieldFixture : testing::Test {
    Harness h;
    std::string value = "north", copied;
    int ends = 0;
    FieldFixture() {
        h.ui->clipboard = {
            .get = [](void* u) { return static_cast<FieldFixture*>(u)->copied; },
            .set = [](void* u, std::string_view t) { static_cast<FieldFixture*>(u)->copied = t; },
            .user = this};
    }
    void frame(std::vector<Event> events) {
        h.frame(std::span<const Event>(events), [this](Ui& ui) {
            ends += text_field(ui, "##f", value).finished;
            button(ui, "after");
        });
    }
};

TEST_F(FieldFixture, TypingSelectionClipboardAndUndo) {
    frame({Event::press({600, 10}), Event::release({600, 10})});
    frame({Event::character(0x4E2D), Event::character(U'é')});
    EXPECT_EQ(value, "north中é");
    frame({Event::key_down(Key::left, kShift), Event::key_down(Key::left, kShift),
           Event::key_down(Key::x, kCtrl)});
    EXPECT_EQ(value, "north");
    EXPECT_EQ(copied, "中é");
    frame({Event::key_down(Key::home), Event::key_down(Key::v, kCtrl)});
    EXPECT_EQ(value, "中énorth");
    frame({Event::key_down(Key::z, kCtrl)});
    EXPECT_EQ(value, "north");
    frame({Event::key_down(Key::enter)});
    EXPECT_EQ(ends, 0) << "nothing changed in the end";
    frame({Event::key_down(Key::tab)});
    frame(typed("x"));
    frame({Event::key_down(Key::tab)});
    EXPECT_EQ(value, "x");
    EXPECT_EQ(ends, 1) << "leaving by Tab ends the edit";
}

TEST_F(FieldFixture, EscapeRestoresAndKeysDoNotReachShortcuts) {
    frame({Event::press({600, 10}), Event::release({600, 10})});
    frame({Event::key_down(Key::s), Event::character(U's'), Event::key_down(Key::digit_1),
           Event::character(U'1')});
    EXPECT_TRUE(h.last.keys.empty());
    EXPECT_EQ(value, "norths1");
    frame({Event::key_down(Key::s, kCtrl)});
    ASSERT_EQ(h.last.keys.size(), 1u) << "Ctrl+S passes through";
    frame({Event::key_down(Key::escape)});
    EXPECT_EQ(value, "north");
    frame({Event::key_down(Key::s)});
    EXPECT_EQ(h.last.keys.size(), 1u);
}

struct DemoFixture : testing::Test {
    Harness h;
    Demo demo;
    void frame(std::vector<Event> events) {
        h.frame(std::span<const Event>(events), [this](Ui& ui) { demo.build(ui); });
    }
};

TEST_F(DemoFixture, HasNoSharedIds) {
    frame({});
    EXPECT_EQ(h.last.duplicate_ids, 0);
}

TEST_F(DemoFixture, MenusWalkByKeyboard) {
    frame({Event::key_down(Key::f10)});
    EXPECT_TRUE(h.last.wants_keyboard);
    frame({Event::key_down(Key::down), Event::key_down(Key::down), Event::key_down(Key::enter)});
    EXPECT_EQ(demo.saved, 1);
    EXPECT_FALSE(h.last.wants_keyboard);
    // Right twice to View, its only entry toggles; a disabled entry is stepped over on the way.
    frame({Event::key_down(Key::f10)});
    frame({Event::key_down(Key::right)});
    frame({Event::key_down(Key::right)});
    frame({Event::key_down(Key::down), Event::key_down(Key::enter)});
    EXPECT_TRUE(demo.grid);
    frame({Event::key_down(Key::f10)});
    frame({Event::key_down(Key::down), Event::key_down(Key::down), Event::key_down(Key::down),
           Event::key_down(Key::enter)});
    EXPECT_TRUE(dialog_open(*h.ui, "Delete layer?")) << "Revert is disabled";
    frame({Event::key_down(Key::escape)});
    frame({Event::key_down(Key::escape)});
    EXPECT_FALSE(dialog_open(*h.ui, "Delete layer?"));
}

TEST_F(DemoFixture, MenusWorkByMouseAndCloseOutside) {
    frame({Event::press({30, 18}), Event::release({30, 18})});
    frame({Event::press({60, 76}), Event::release({60, 76})});
    EXPECT_EQ(demo.saved, 1);
    frame({Event::press({30, 18}), Event::release({30, 18})});
    const int tool = demo.tool;
    frame({Event::press({22, 500}), Event::release({22, 500})});
    EXPECT_FALSE(h.last.wants_keyboard);
    EXPECT_EQ(demo.tool, tool) << "the press that closes does nothing else";
    // One press: open, drag to the entry, let go.
    frame({Event::press({30, 18})});
    frame({Event::move({60, 76}), Event::release({60, 76})});
    EXPECT_EQ(demo.saved, 2);
}

TEST_F(DemoFixture, ADialogIsModal) {
    open_dialog(*h.ui, "Delete layer?");
    frame({});
    EXPECT_TRUE(h.last.wants_mouse);
    frame({Event::press({22, 96}), Event::release({22, 96})});
    EXPECT_EQ(demo.tool, 0);
    frame({Event::key_down(Key::s, kCtrl)});
    EXPECT_TRUE(h.last.keys.empty());
    int answer = -1;
    for (int i = 0; i < 2; ++i) frame({Event::key_down(Key::tab)});
    std::vector<Event> enter{Event::key_down(Key::enter)};
    h.frame(std::span<const Event>(enter), [&](Ui& ui) {
        demo.build(ui);
        answer = std::max(answer, demo.dialog_answer);
    });
    EXPECT_EQ(answer, 1);
    EXPECT_FALSE(dialog_open(*h.ui, "Delete layer?"));
}

TEST_F(DemoFixture, TheSplitterResizesWithinItsLimits) {
    frame({});
    frame({Event::press({961, 400}), Event::move({861, 400})});
    EXPECT_FLOAT_EQ(demo.side, 420);
    frame({Event::move({-500, 400}), Event::release({-500, 400})});
    EXPECT_FLOAT_EQ(demo.side, 640);
    EXPECT_FLOAT_EQ(demo.view.rect.right(), 640);
}

TEST_F(DemoFixture, TheViewportCapturesAndGivesItsPlace) {
    frame({Event::move({500, 300})});
    EXPECT_TRUE(demo.view.hovered);
    EXPECT_FALSE(h.last.wants_mouse);
    frame({Event::press({500, 300}, MouseButton::right), Event::move({510, 320})});
    EXPECT_TRUE(demo.view.held);
    EXPECT_EQ(demo.view.drag, (Vec2{10, 20}));
    frame({Event::move({1270, 320})});
    EXPECT_TRUE(demo.view.held);
    EXPECT_FALSE(h.last.wants_mouse);
    frame({Event::release({1270, 320}, MouseButton::right)});
    EXPECT_FALSE(demo.view.held);
    EXPECT_TRUE(h.last.wants_mouse);
    h.ui->begin_frame({.events = std::vector{Event::move({500, 300}), Event::scroll({0, 2})},
                       .time_s = h.time_s,
                       .size_px = h.size});
    demo.build(*h.ui);
    h.ui->end_frame();
    EXPECT_FLOAT_EQ(demo.view.wheel, 2);
}

TEST_F(DemoFixture, IdleIsIdle) {
    frame({Event::move({500, 300})});
    h.time_s += 100;
    frame({});
    EXPECT_FALSE(h.last.redraw);
    EXPECT_FALSE(h.last.picture_changed);
    EXPECT_TRUE(std::isinf(h.last.wake_s));
    // A caret blinks, then rests.
    frame({Event::press({1200, 298}), Event::release({1200, 298})});
    EXPECT_LE(h.last.wake_s, h.time_s + 0.54);
    h.time_s += 60;
    frame({});
    EXPECT_TRUE(std::isinf(h.last.wake_s));
}

TEST_F(DemoFixture, ATooltipWaitsShowsAndGoes) {
    frame({Event::move({22, 58})});
    const size_t before = h.last.draw->quads().size();
    EXPECT_NEAR(h.last.wake_s, h.time_s + 0.5, 1e-6);
    h.time_s += 0.4;
    frame({});
    EXPECT_EQ(h.last.draw->quads().size(), before);
    h.time_s = h.last.wake_s;
    frame({});
    EXPECT_GT(h.last.draw->quads().size(), before);
    EXPECT_TRUE(std::isinf(h.last.wake_s));
    frame({Event::move({500, 300})});
    EXPECT_LT(h.last.draw->quads().size(), before + 2);
}

TEST(UiScroll, OffsetsStayInRangeAndTheFocusIsFollowed) {
    Harness h;
    float bottom = 0;
    std::array<Rect, 40> places;
    ScrollState* state = nullptr;
    const auto build = [&](Ui& ui) {
        state = &scroll_state(ui, "list");
        auto area = scroll_area(ui, "list", 200);
        for (int i = 0; i < 40; ++i) {
            button(ui, "b##" + std::to_string(i));
            bottom = ui.content_end();
        }
    };
    h.frame({Event::move({100, 100})}, build);
    EXPECT_FLOAT_EQ(state->limit, 40 * 28 - 4 - 200);
    h.frame({Event::scroll({0, 5})}, build);
    EXPECT_FLOAT_EQ(state->offset, 0);
    h.frame({Event::scroll({0, -1000})}, build);
    EXPECT_FLOAT_EQ(state->offset, state->limit);
    EXPECT_NEAR(bottom, 200, 1);
    h.frame({Event::press({1275, 199}), Event::move({1275, -900}), Event::release({1275, -900})}, build);
    EXPECT_FLOAT_EQ(state->offset, 0);
    for (int i = 0; i < 20; ++i) h.frame({Event::key_down(Key::tab)}, build);
    EXPECT_GT(state->offset, 300);
    EXPECT_LE(state->offset, state->limit);
}

// Every quad's clip lies within the window, and what a scroll area holds is cut to it.
TEST_F(DemoFixture, ClipsAreNested) {
    frame({});
    for (const UiQuad& q : h.last.draw->quads()) {
        ASSERT_GE(q.clip_x0, 0);
        ASSERT_GE(q.clip_y0, 0);
        ASSERT_LE(q.clip_x1, 1280);
        ASSERT_LE(q.clip_y1, 800);
        if (q.x0 > 980 && q.y0 > 740 && q.kind == kQuadGlyph && q.y0 < 774) {
            ASSERT_LE(q.clip_y1, 774);
        }
    }
    DrawList list;
    list.clear({0, 0, 100, 100});
    list.push_clip({50, 50, 100, 100});
    list.push_clip({0, 0, 60, 60});
    EXPECT_EQ(list.clip(), (Rect{50, 50, 10, 10}));
    list.rect({0, 0, 10, 10}, Color{});
    EXPECT_TRUE(list.quads().empty()) << "nothing outside is drawn";
    list.rect({55, 55, 100, 10}, Color{});
    EXPECT_EQ(list.quads().size(), 1u);
}

TEST(UiShortcuts, OneActionAKey) {
    Shortcuts s;
    s.bind("save", Key::s, kCtrl);
    s.bind("search", Key::s, kCtrl);
    EXPECT_EQ(s.find(Key::s, kCtrl), "search");
    EXPECT_EQ(s.label("save"), "");
    s.bind("redo", Key::z, {.ctrl = true, .shift = true});
    EXPECT_EQ(s.label("redo"), "Ctrl+Shift+Z");
    EXPECT_FALSE(s.find(Key::s, {}));
}

TEST(UiFuzz, RandomEventsNeverCrashAndLeaveNothingCaptured) {
    std::mt19937 random(11);
    Harness h;
    Demo demo;
    const auto build = [&](Ui& ui) {
        demo.build(ui);
        ASSERT_TRUE(demo.radius >= 0.5 && demo.radius <= 200);
        ASSERT_TRUE(demo.count >= 1 && demo.count <= 12);
        ASSERT_TRUE(demo.layer >= -1 && demo.layer < 5);
    };
    std::vector<Event> batch;
    for (int i = 0; i < 10000; ++i) {
        const Vec2 at{float(random() % 1400) - 50, float(random() % 900) - 50};
        const Mods mods{.ctrl = random() % 5 == 0, .shift = random() % 5 == 0};
        switch (random() % 10) {
            case 0:
            case 1:
                batch.push_back(Event::move(at));
                break;
            case 2:
                batch.push_back(Event::press(at, MouseButton(random() % 8 == 0 ? random() % 3 : 0), mods));
                break;
            case 3:
            case 4:
                batch.push_back(Event::release(at, MouseButton(random() % 8 == 0 ? random() % 3 : 0), mods));
                break;
            case 5:
                batch.push_back(Event::scroll({0, float(random() % 21) - 10}));
                break;
            case 6:
            case 7:
                batch.push_back(Event::key_down(Key(random() % unsigned(Key::count)), mods));
                break;
            case 8:
                batch.push_back(Event::character(char32_t(random() % 3 ? 32 + random() % 95 : random())));
                break;
            default:
                if (random() % 20 == 0) batch.push_back(random() % 2 ? Event::blur() : Event::leave());
                if (random() % 40 == 0) batch.push_back(Event::move({NAN, INFINITY}));
        }
        if (random() % 3) continue;
        if (random() % 50 == 0) h.size = {float(random() % 1600), float(random() % 1000)};
        h.time_s += double(random() % 1000) / 1000.0;
        h.ui->begin_frame({.events = batch, .time_s = h.time_s, .size_px = h.size});
        build(*h.ui);
        h.ui->end_frame();
        batch.clear();
    }
    h.size = {1280, 800};
    h.frame({Event::release({0, 0}), Event::release({0, 0}, MouseButton::right),
             Event::release({0, 0}, MouseButton::middle)},
            build);
    for (int i = 0; i < 1000 && h.last.redraw; ++i) h.frame({}, build);
    EXPECT_FALSE(h.last.redraw);
    EXPECT_FALSE(h.last.captured);
    EXPECT_EQ(h.last.duplicate_ids, 0);
}

TEST(UiWidgets, WhatIsTypedAfterAShortcutGoesToTheDialogThatItOpens) {
    Harness h;
    std::string name;
    const auto build = [&](Ui& ui) {
        if (ui.take_key(Key::l, kCtrl)) open_dialog(ui, "Name it");
        if (auto asked = dialog(ui, "Name it", 300)) text_field(ui, "Name", name);
    };
    std::vector<Event> batch = {Event::key_down(Key::l, kCtrl)};  // all at once, as after a long frame
    for (const Event& e : typed("/a/b")) batch.push_back(e);
    h.frame(std::span<const Event>(batch), build);
    EXPECT_EQ(name, "/a/b");
}

TEST(UiWidgets, ATextAreaIsTypedInAndScrolls) {
    Harness h;
    std::string value = "one\ntwo\nthree";
    const TextAreaMark marks[] = {{2, "wrong"}};
    const auto build = [&](Ui& ui) {
        auto column = ui.column_in({0, 0, 400, 100});
        text_area(ui, "code", value, {.marks = marks});
    };
    h.frame({}, build);
    h.frame(typed("x"), build);
    EXPECT_EQ(value, "one\ntwo\nthree") << "not before it is clicked";
    h.frame({Event::move({300, 25}), Event::press({300, 25})}, build);
    h.frame({Event::release({300, 25})}, build);
    EXPECT_TRUE(h.last.wants_keyboard);
    h.frame(typed("!"), build);
    EXPECT_EQ(value, "one\ntwo!\nthree") << "a click beside a line goes to its end";
    h.frame({Event::key_down(Key::enter)}, build);
    h.frame({Event::key_down(Key::tab)}, build);
    h.frame(typed("y"), build);
    EXPECT_EQ(value, "one\ntwo!\n    y\nthree");
    h.frame({Event::key_down(Key::home, kShift)}, build);
    h.frame({Event::key_down(Key::del)}, build);
    EXPECT_EQ(value, "one\ntwo!\n\nthree");
    for (int i = 0; i < 20; ++i) h.frame({Event::key_down(Key::enter)}, build);
    h.frame(typed("z"), build);
    EXPECT_EQ(value.find("z"), std::string("one\ntwo!\n\n").size() + 19);
    // The caret is in view: a click at the foot lands near it, not at the text's beginning.
    h.frame({Event::move({100, 90}), Event::press({100, 90})}, build);
    h.frame({Event::release({100, 90})}, build);
    h.frame(typed("#"), build);
    EXPECT_GT(value.find("#"), 20u);
    h.frame({Event::key_down(Key::z, kCtrl)}, build);
    EXPECT_EQ(value.find("#"), std::string::npos);
    h.frame({Event::key_down(Key::escape)}, build);
    h.frame({}, build);
    h.frame(typed("q"), build);
    EXPECT_EQ(value.find("q"), std::string::npos) << "Escape gives the keyboard back";
    value = "given";
    h.frame({}, build);
    EXPECT_EQ(value, "given");
}

}  // namespace
}  // namespace loam::ui
