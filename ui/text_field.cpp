#include "ui/text_field.h"

#include <cmath>

#include "ui/edit_keys.h"
#include "ui/utf8.h"

namespace loam::ui {
LineResult edit_line(Ui& ui, const Response& field, const Rect& area, LineState& line) {
    LineResult result;
    TextEdit& edit = line.edit;
    const std::string before = edit.text();
    ui.want_keyboard();
    for (Ui::KeyEvent& k : ui.keys()) {
        if (k.used || result.accepted || result.cancelled) continue;
        if (k.event.type == Event::Type::text) {
            std::string character;
            append_utf8(character, k.event.codepoint);
            edit.insert(character);
            k.used = true;
        } else {
            const EditKey key = apply_edit_key(ui, k.event, edit);
            result.accepted = key == EditKey::accepted;
            result.cancelled = key == EditKey::cancelled;
            k.used = key != EditKey::not_ours;
        }
    }
    const float origin = area.x - line.scroll_px;
    if (field.pressed || field.held) {
        const size_t at = caret_at_x(ui.text().shape(edit.text(), ui.style()), ui.mouse().x - origin);
        if (field.double_clicked)
            edit.select_word(at);
        else if (field.pressed || ui.mouse_moved())
            edit.place(at, field.pressed && !ui.mods().shift ? Select::no : Select::yes);
    }
    result.changed = edit.text() != before;

    const ShapedText& shaped = ui.text().shape(edit.text(), ui.style());
    const float caret = caret_x(shaped, edit.caret());
    line.scroll_px = std::clamp(line.scroll_px, caret - area.w + ui.px(2), caret);
    line.scroll_px = std::max(0.0f, std::min(line.scroll_px, shaped.width - area.w + ui.px(2)));
    const float x = area.x - std::round(line.scroll_px);

    ui.draw().push_clip(area);
    const float cap = ui.text().metrics(ui.style()).cap_height;
    const float middle = area.center().y, height = ui.px(16);
    if (edit.has_selection()) {
        const float a = caret_x(shaped, edit.selection_begin()), b = caret_x(shaped, edit.selection_end());
        ui.draw().rect({std::round(x + a), std::round(middle - height * 0.5f), std::round(b - a), height},
                       ui.theme.accent_soft, ui.px(2));
    }
    ui.draw().text(ui.text(), {x, std::floor(area.y + (area.h + cap) * 0.5f)}, edit.text(), ui.style(),
                   ui.theme.text);
    ui.draw().pop_clip();

    // The caret rests, lit, after some seconds without input, so that an idle window stays idle.
    const double idle = ui.time_s() - ui.last_input_s(), blink = double(ui.theme.caret_blink_s);
    const bool resting = idle >= double(ui.theme.caret_rest_s);
    if (!resting) ui.wake_at(ui.last_input_s() + (std::floor(idle / blink + 1e-6) + 1) * blink);
    if (resting || int64_t(std::floor(idle / blink + 1e-6)) % 2 == 0)
        ui.draw().rect({std::round(x + caret), std::round(middle - height * 0.5f), ui.px(1), height},
                       ui.theme.text);
    return result;
}

namespace {

struct FieldState {
    LineState line;
    std::string original;
    bool editing = false;
};

}  // namespace

Edit text_field(Ui& ui, std::string_view name, std::string& value, const TextFieldDesc& desc) {
    const Theme& t = ui.theme;
    const Rect place = labelled(ui, name, 160);
    const Id id = ui.make_id(name);
    const Response r = ui.interact(id, place, Sense::edit);
    auto& state = ui.state<FieldState>(id);
    Edit result;
    if (r.focused && !state.editing) {
        state.editing = true;
        state.original = value;
        state.line = {};
        state.line.edit.max_bytes = desc.max_bytes;
        state.line.edit.set_text(value);
        if (r.focus_visible) state.line.edit.select_all();
    }
    if (!r.focused && state.editing) {
        state.editing = false;
        result.finished = value != state.original;
    }
    if (r.hovered) ui.set_cursor(Cursor::text);

    draw_field(ui, r);
    Rect inner = place.inset(ui.px(8), 0);
    if (desc.icon != Icon::none) {
        const Rect icon = cut(inner, Edge::left, ui.px(20));
        ui.draw().icon(ui.text(), desc.icon, {icon.x + ui.px(7), icon.center().y}, ui.px(16), t.text_dim);
    }
    if (state.editing) {
        if (state.line.edit.text() != value) state.line.edit.set_text(value);  // the application changed it
        if (value.empty()) ui.draw_label(inner, desc.placeholder, ui.style(), t.text_disabled);
        const LineResult line = edit_line(ui, r, inner, state.line);
        if (line.changed) value = state.line.edit.text(), result.changed = true;
        if (line.cancelled) {
            result.changed |= value != state.original;
            value = state.original;
        }
        if (line.accepted || line.cancelled) {
            state.editing = false;
            result.finished = line.accepted && value != state.original;
            ui.set_focus(0, false);
        }
        ui.draw().rect(place, kTransparent, ui.px(t.radius), t.accent, ui.px(1));
    } else {
        const bool empty = value.empty();
        ui.draw_label(inner, empty ? desc.placeholder : std::string_view(value), ui.style(),
                      empty || ui.disabled() ? t.text_disabled : t.text);
    }
    return result;
}

}  // namespace loam::ui
