#include "ui/text.h"

#include <random>

#include <gtest/gtest.h>

#include "ui/draw_list.h"
#include "ui/text_edit.h"
#include "ui/theme.h"
#include "ui/utf8.h"

namespace loam::ui {
namespace {

std::unique_ptr<Text> make_text() {
    auto text = Text::create();
    EXPECT_TRUE(text.ok());
    return std::move(text).value();
}

TEST(UiText, AMissingFontIsAClearError) {
    const auto text =
        Text::create({.regular = {"/nowhere/a.ttf"}, .medium = {}, .semibold = {}, .fallbacks = {}});
    ASSERT_FALSE(text.ok());
    EXPECT_NE(text.message().find("fonts-inter"), std::string::npos);
    EXPECT_NE(text.message().find("/nowhere/a.ttf"), std::string::npos);
}

// Kerning moves a joint by a fraction of an em at most; without letters at the joint widths add exactly.
TEST(UiText, WidthsAdd) {
    const auto text = make_text();
    const TextStyle style{Weight::regular, 13};
    for (const auto& [a, b] : {std::pair("Radius", "12.5"), std::pair("AV", "AT"), std::pair("Zür", "ich")})
        EXPECT_NEAR(text->measure(std::string(a) + b, style),
                    text->measure(a, style) + text->measure(b, style), 0.15f * 13)
            << a << b;
    EXPECT_FLOAT_EQ(text->measure("", style), 0);
    EXPECT_GT(text->measure("WW", style), text->measure("ii", style));
    EXPECT_NEAR(text->measure("Strength", {Weight::regular, 26}), 2 * text->measure("Strength", style), 0.6f);
}

TEST(UiText, CaretStopsNeverRunBackAndCoverEveryCodePoint) {
    const auto text = make_text();
    const std::string words = "Höhe ﬁ 中文 e\u0301 😀 end";
    const ShapedText& shaped = text->shape(words, {Weight::regular, 17});
    size_t at = 0;
    float x = -1;
    for (const CaretStop& stop : shaped.carets) {
        EXPECT_EQ(stop.byte, at);
        EXPECT_GE(stop.x, x);
        x = stop.x;
        at = at < words.size() ? next_codepoint(words, at) : at + 1;
    }
    EXPECT_FLOAT_EQ(x, shaped.width);
    EXPECT_EQ(caret_at_x(shaped, -50), 0u);
    EXPECT_EQ(caret_at_x(shaped, 1e6f), words.size());
}

TEST(UiText, AnEllipsisFitsAndIsAsLongAsPossible) {
    const auto text = make_text();
    const TextStyle style{Weight::regular, 13};
    const std::string whole = "Mud with gravel and roots";
    for (float width = 0; width < 220; width += 0.7f) {
        const std::string fitted = text->ellipsis(whole, style, width);
        ASSERT_LE(text->measure(fitted, style), width + 0.01f);
        if (text->measure(whole, style) <= width) {
            ASSERT_EQ(fitted, whole);
        }
    }
    EXPECT_EQ(text->ellipsis("ä中é", style, 0), "");
}

TEST(UiText, GarbageNeverCrashesAndRoundTripsAsReplacement) {
    const auto text = make_text();
    std::mt19937 random(7);
    DrawList list;
    list.clear({0, 0, 500, 100});
    for (int round = 0; round < 2000; ++round) {
        std::string bytes;
        for (int i = 0, n = int(random() % 24); i < n; ++i) bytes += char(random() & 255u);
        const ShapedText& shaped = text->shape(bytes, {Weight::regular, 13});
        ASSERT_TRUE(std::isfinite(shaped.width));
        if (round % 10 == 0) list.text(*text, {3, 50}, bytes, {Weight::regular, 13}, Color{});
        size_t forward = 0, back = bytes.size();
        std::vector<size_t> on, off;
        while (forward < bytes.size()) on.push_back(forward), forward = next_codepoint(bytes, forward);
        while (back > 0) back = previous_codepoint(bytes, back), off.insert(off.begin(), back);
        ASSERT_EQ(on, off) << "stepping on and back visit the same places";
    }
    for (const char* bad : {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80", "\xE2\x82"})
        EXPECT_EQ(decode_utf8(bad, 0).codepoint, char32_t(0xFFFD));
}

TEST(UiText, AMissingGlyphIsABox) {
    const auto text = make_text();
    const ShapedText& shaped = text->shape("\U000E0FF0", {Weight::regular, 13});
    ASSERT_EQ(shaped.glyphs.size(), 1u);
    EXPECT_EQ(shaped.glyphs[0].face, -1);
    EXPECT_GT(shaped.width, 0);
}

TEST(UiText, TheAtlasGrowsThenFillsThenServesAgain) {
    GlyphAtlas atlas;
    const std::vector<uint8_t> block(size_t(100) * 100, 255);
    std::vector<TexelRect> slots;
    while (const auto slot = atlas.add(100, 100, block.data(), 100)) {
        for (const TexelRect& other : slots) ASSERT_TRUE(intersected(*slot, other).empty());
        slots.push_back(*slot);
    }
    EXPECT_TRUE(atlas.full());
    EXPECT_EQ(atlas.height(), GlyphAtlas::kMaxHeight);
    EXPECT_GT(slots.size(), 180u);
    atlas.clear();
    EXPECT_TRUE(atlas.add(100, 100, block.data(), 100).has_value());
    EXPECT_FALSE(atlas.take_dirty().empty());
    EXPECT_TRUE(atlas.take_dirty().empty());
}

TEST(UiText, EveryIconHasInkAndNoneTouchesItsBorder) {
    for (int i = 1; i < int(Icon::count); ++i) {
        const auto picture = rasterise_icon(Icon(i), 20);
        int ink = 0, border = 0;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x) {
                ink += picture[size_t(y * 20 + x)] > 100;
                if (x == 0 || y == 0 || x == 19 || y == 19) border += picture[size_t(y * 20 + x)] > 150;
            }
        EXPECT_GT(ink, 8) << i;
        EXPECT_EQ(border, 0) << i;
    }
}

TEST(UiTheme, ContrastIsReadable) {
    const Theme t;
    for (const Color back : {t.panel, t.popup, t.header, t.field, t.button, t.accent_soft, t.fill}) {
        EXPECT_GE(contrast_ratio(t.text, back), 4.5f);
        EXPECT_GE(contrast_ratio(t.text_dim, back), 3.0f);
    }
    EXPECT_GE(contrast_ratio(t.accent_text, t.accent), 3.0f);
}

TEST(UiTextEdit, EditsMultibyteText) {
    TextEdit e;
    e.set_text("aé中😀");
    e.erase_back(Step::codepoint);
    EXPECT_EQ(e.text(), "aé中");
    e.move_back(Step::codepoint, Select::no);
    e.insert("ß");
    EXPECT_EQ(e.text(), "aéß中");
    e.move_back(Step::all, Select::yes);
    EXPECT_EQ(e.selected(), "aéß");
    e.insert("x");
    EXPECT_EQ(e.text(), "x中");
    EXPECT_TRUE(e.undo());
    EXPECT_EQ(e.text(), "aéß中");
    EXPECT_TRUE(e.redo());
    EXPECT_EQ(e.text(), "x中");
}

TEST(UiTextEdit, WordsAndLimits) {
    TextEdit e;
    e.set_text("north ridge, höhe");
    e.move_back(Step::word, Select::no);
    EXPECT_EQ(e.caret(), 13u);
    e.erase_back(Step::word);
    EXPECT_EQ(e.text(), "north höhe");
    e.select_word(8);
    EXPECT_EQ(e.selected(), "höhe");
    e.max_bytes = 11;
    e.place(0, Select::no);
    e.insert("ää");
    EXPECT_EQ(e.text(), "north höhe") << "11 bytes are taken; nothing may be cut inside a code point";
    e.max_bytes = 13;
    e.insert("ää\n\x01");
    EXPECT_EQ(e.text(), "änorth höhe");
}

TEST(UiTextEdit, ManyLines) {
    TextEdit e;
    e.many_lines = true;
    e.set_text("long line\n  äö\n\nlast");
    e.place(7, Select::no);
    e.move_lines(1, Select::no);
    EXPECT_EQ(e.caret(), e.line_end(10)) << "the line is shorter";
    e.move_lines(1, Select::no);
    EXPECT_EQ(e.text()[e.caret()], '\n');
    e.move_lines(-2, Select::no);
    EXPECT_EQ(e.caret(), 7u) << "the column is remembered";
    e.move_lines(2, Select::yes);
    EXPECT_EQ(e.selection_begin(), 7u);
    e.move_lines(99, Select::no);
    EXPECT_EQ(e.line_end(e.caret()), e.text().size());
    e.move_back(Step::line, Select::no);
    EXPECT_EQ(e.text().substr(e.caret()), "last");
    e.place(12, Select::no);  // before ä
    e.insert_line_break();
    EXPECT_EQ(e.text(), "long line\n  \n  äö\n\nlast") << "as far in as the line before";
    e.insert("a\tb\nc");
    EXPECT_EQ(e.text(), "long line\n  \n  a    b\ncäö\n\nlast");
    EXPECT_TRUE(e.undo());
    EXPECT_TRUE(e.undo());
    EXPECT_EQ(e.text(), "long line\n  äö\n\nlast");
    e.many_lines = false;
    e.select_all();
    e.insert("a\nb");
    EXPECT_EQ(e.text(), "a b");
}

TEST(UiTextEdit, RandomEditsKeepTheCaretOnCodePoints) {
    TextEdit e;
    std::mt19937 random(3);
    for (int i = 0; i < 20000; ++i) {
        const Select s = random() % 2 ? Select::yes : Select::no;
        const Step step = Step(random() % 3);
        switch (random() % 8) {
            case 0:
                e.move_back(step, s);
                break;
            case 1:
                e.move_on(step, s);
                break;
            case 2:
                e.erase_back(random() % 4 ? Step::codepoint : step);
                break;
            case 3:
                e.erase_on(random() % 4 ? Step::codepoint : step);
                break;
            case 4:
                e.undo();
                break;
            case 5:
                e.place(random() % 60, s);
                break;
            default:
                e.insert(std::string(1 + random() % 3, char(random() & 255u)));
                e.insert("é中");
                break;
        }
        ASSERT_LE(e.caret(), e.text().size());
        size_t at = 0;
        while (at < e.caret()) at = next_codepoint(e.text(), at);
        ASSERT_EQ(at, e.caret());
        if (e.text().size() > 200) e.set_text("");
    }
}

}  // namespace
}  // namespace loam::ui
