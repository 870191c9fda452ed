#include "ui/text_area.h"

#include <algorithm>
#include <cmath>

#include "ui/edit_keys.h"
#include "ui/utf8.h"

namespace loam::ui {

namespace {

constexpr float kLine = 17, kNumbers = 36, kInset = 6;  // logical px

struct AreaState {
    TextEdit edit;
    bool editing = false;
    Vec2 scroll{0, 0};  // px
    float grab = -1;    // of the scroll bar's handle; < 0: not held
};

struct AreaView {
    Ui& ui;
    const Rect text;  // where the lines stand
    const AreaState& state;
    const std::vector<size_t>& lines;  // where each begins
    float line_px, letter_px;

    [[nodiscard]] float top(size_t line) const { return text.y + float(line) * line_px - state.scroll.y; }
    [[nodiscard]] std::string_view content(const std::string& all, size_t line) const {
        const size_t end = line + 1 < lines.size() ? lines[line + 1] - 1 : all.size();
        return std::string_view(all).substr(lines[line], end - lines[line]);
    }
    [[nodiscard]] size_t line_of(size_t byte) const {
        return size_t(std::upper_bound(lines.begin(), lines.end(), byte) - lines.begin()) - 1;
    }
    [[nodiscard]] size_t byte_at(const std::string& all, Vec2 mouse) const {
        const float row = (mouse.y - text.y + state.scroll.y) / line_px;
        const size_t line = size_t(std::clamp(row, 0.0f, float(lines.size() - 1)));
        return lines[line] + caret_at_x(ui.text().shape(content(all, line), ui.code_style()),
                                        mouse.x - text.x + state.scroll.x);
    }
    [[nodiscard]] float x_of(const std::string& all, size_t line, size_t byte) const {
        return caret_x(ui.text().shape(content(all, line), ui.code_style()), byte - lines[line]);
    }
};

std::vector<size_t> line_begins(const std::string& text) {
    std::vector<size_t> begins{0};
    for (size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
        begins.push_back(at + 1);
    return begins;
}

void take_keys(Ui& ui, AreaState& state, int lines_a_page) {
    ui.want_keyboard();
    for (Ui::KeyEvent& k : ui.keys()) {
        if (k.used || !state.editing) continue;
        if (k.event.type == Event::Type::text) {
            std::string character;
            append_utf8(character, k.event.codepoint);
            state.edit.insert(character);
            k.used = true;
            continue;
        }
        const EditKey key = apply_edit_key(ui, k.event, state.edit, lines_a_page);
        k.used = key != EditKey::not_ours;
        if (key == EditKey::cancelled) state.editing = false;
    }
}

// The caret stays in view when it moved.
void follow_caret(const AreaView& v, AreaState& state, const std::string& all) {
    const size_t line = v.line_of(state.edit.caret());
    const float y = float(line) * v.line_px, x = v.x_of(all, line, state.edit.caret());
    state.scroll.y = std::clamp(state.scroll.y, y + v.line_px - v.text.h, y);
    state.scroll.x = std::clamp(state.scroll.x, x + v.letter_px - v.text.w, std::max(x - v.letter_px, 0.0f));
}

void draw_lines(const AreaView& v, const std::string& all, const TextAreaDesc& desc, const Rect& place) {
    Ui& ui = v.ui;
    const TextStyle style = ui.code_style();
    const float cap = ui.text().metrics(style).cap_height;
    const size_t first = size_t(std::max(0.0f, v.state.scroll.y / v.line_px));
    const TextEdit& edit = v.state.edit;
    for (size_t line = first; line < v.lines.size() && v.top(line) < place.bottom(); ++line) {
        const float y = v.top(line), baseline = std::floor(y + (v.line_px + cap) * 0.5f);
        const auto mark = std::find_if(desc.marks.begin(), desc.marks.end(),
                                       [&](const TextAreaMark& m) { return size_t(m.line) == line + 1; });
        const Rect row{place.x, y, place.w, v.line_px};
        if (mark != desc.marks.end()) {
            ui.draw().rect(row, ui.theme.error.faded(0.16f));
            ui.draw().rect({row.x, row.y, ui.px(3), row.h}, ui.theme.error);
            const Response over = ui.interact(ui.make_id(fmt::format("mark{}", line)),
                                              {row.x, row.y, ui.px(kNumbers), row.h}, Sense::hover);
            ui.tooltip(over, mark->says);
        }
        ui.draw_label({row.x, row.y, ui.px(kNumbers - kInset), row.h}, fmt::format("{}", line + 1),
                      ui.small_style(), ui.theme.text_disabled, Ui::Align::right);
        ui.draw().push_clip(v.text);
        const std::string_view content = v.content(all, line);
        if (v.state.editing && edit.has_selection()) {
            const size_t end = v.lines[line] + content.size();
            const size_t from = std::max(edit.selection_begin(), v.lines[line]);
            const size_t to = std::min(edit.selection_end(), end);
            const bool break_too = edit.selection_end() > end && edit.selection_begin() <= end;
            if (from < to || break_too) {
                const float a = v.x_of(all, line, std::min(from, end)),
                            b = v.x_of(all, line, std::max(from, to));
                ui.draw().rect(
                    {v.text.x + a - v.state.scroll.x, y, b - a + (break_too ? v.letter_px : 0), v.line_px},
                    ui.theme.accent_soft);
            }
        }
        const size_t comment = content.find("//");
        const auto part = [&](std::string_view words, size_t at, Color color) {
            if (words.empty()) return;
            const float x = caret_x(ui.text().shape(content, style), at);
            ui.draw().text(ui.text(), {v.text.x + std::round(x - v.state.scroll.x), baseline}, words, style,
                           color);
        };
        part(content.substr(0, std::min(comment, content.size())), 0, ui.theme.text);
        if (comment != std::string_view::npos) part(content.substr(comment), comment, ui.theme.text_dim);
        ui.draw().pop_clip();
    }
}

void draw_caret(const AreaView& v, const std::string& all) {
    Ui& ui = v.ui;
    // It rests, lit, after some seconds without input, so that an idle window stays idle.
    const double idle = ui.time_s() - ui.last_input_s(), blink = double(ui.theme.caret_blink_s);
    const bool resting = idle >= double(ui.theme.caret_rest_s);
    if (!resting) ui.wake_at(ui.last_input_s() + (std::floor(idle / blink + 1e-6) + 1) * blink);
    if (!resting && int64_t(std::floor(idle / blink + 1e-6)) % 2 != 0) return;
    const size_t line = v.line_of(v.state.edit.caret());
    const float x = v.text.x + v.x_of(all, line, v.state.edit.caret()) - v.state.scroll.x;
    ui.draw().push_clip(v.text);
    ui.draw().rect({std::round(x), v.top(line) + ui.px(1), ui.px(1), v.line_px - ui.px(2)}, ui.theme.text);
    ui.draw().pop_clip();
}

void scroll_bar(Ui& ui, AreaState& state, const Rect& place, float limit) {
    if (limit <= 0) {
        state.scroll.y = 0;
        return;
    }
    const float share = place.h / (place.h + limit), length = std::max(place.h * share, ui.px(24));
    const auto y_of = [&](float offset) { return place.y + (place.h - length) * offset / limit; };
    const Rect track{place.right() - ui.px(8), place.y, ui.px(8), place.h};
    const Response r = ui.interact(ui.make_id("scroll"), track, Sense::drag);
    if (r.pressed) state.grab = std::clamp(ui.mouse().y - y_of(state.scroll.y), 0.0f, length);
    if (r.pressed || r.held)
        state.scroll.y = (ui.mouse().y - state.grab - place.y) / std::max(place.h - length, 1.0f) * limit;
    float notches = 0;
    if (ui.take_wheel(place, notches)) state.scroll.y -= notches * ui.px(3 * kLine);
    state.scroll.y = std::clamp(state.scroll.y, 0.0f, limit);
    ui.draw().rect({track.x + ui.px(2), y_of(state.scroll.y), track.w - ui.px(4), length},
                   r.hovered || r.held ? ui.theme.scroll_bar_hover : ui.theme.scroll_bar, ui.px(2));
}

}  // namespace

Edit text_area(Ui& ui, std::string_view name, std::string& value, const TextAreaDesc& desc) {
    const Rect place = ui.allocate_rest();
    const Id id = ui.make_id(name);
    auto& state = ui.state<AreaState>(id);
    ui.push_id(id);
    const float line_px = std::round(ui.px(kLine)), letter_px = ui.text().measure("0", ui.code_style());
    const Rect text{place.x + ui.px(kNumbers), place.y, std::max(place.w - ui.px(kNumbers + 10), 1.0f),
                    place.h};
    const Rect field{place.x, place.y, place.w - ui.px(8), place.h};
    const Response r = ui.interact(ui.make_id("text"), field, Sense::edit);
    Edit result;
    state.edit.many_lines = true;
    state.edit.max_bytes = desc.max_bytes;
    if (state.edit.text() != value) {  // the application changed it
        state.edit.set_text(value);
        state.edit.place(0, Select::no);
        state.scroll = {0, 0};
    }
    if (r.focused && (r.pressed || r.focus_visible)) state.editing = true;
    if (!r.focused) state.editing = false;
    if (r.hovered) ui.set_cursor(Cursor::text);

    ui.draw().rect(place, ui.theme.field, ui.px(ui.theme.radius));
    const size_t caret_before = state.edit.caret();
    if (state.editing) take_keys(ui, state, std::max(1, int(place.h / line_px) - 1));
    if (r.focused && !state.editing) ui.set_focus(0, false);
    std::vector<size_t> lines = line_begins(state.edit.text());
    const AreaView v{ui, text, state, lines, line_px, letter_px};
    if (state.editing && (r.pressed || r.held)) {
        const size_t at = v.byte_at(state.edit.text(), ui.mouse());
        if (r.double_clicked)
            state.edit.select_word(at);
        else if (r.pressed || ui.mouse_moved())
            state.edit.place(at, r.pressed && !ui.mods().shift ? Select::no : Select::yes);
    }
    if (state.edit.text() != value) {
        value = state.edit.text();
        result.changed = true;
    }
    if (state.edit.caret() != caret_before || result.changed) follow_caret(v, state, value);
    scroll_bar(ui, state, place, float(lines.size()) * line_px - place.h);
    state.scroll.x = std::max(state.scroll.x, 0.0f);

    ui.draw().push_clip(place);
    draw_lines(v, value, desc, place);
    if (state.editing) draw_caret(v, value);
    ui.draw().pop_clip();
    if (state.editing) ui.draw().rect(place, kTransparent, ui.px(ui.theme.radius), ui.theme.accent, ui.px(1));
    ui.pop_id();
    return result;
}

}  // namespace loam::ui
