#include "ui/menu.h"

#include <cmath>

namespace loam::ui {
namespace {

struct BarState {
    std::vector<Id> before, now;  // titles in order, of the last frame and of this one
    Rect rect;
    bool f10 = false;
};
constexpr Id kBarId = 0xBA4;

BarState& bar(Ui& ui) {
    return ui.state<BarState>(kBarId);
}

Id open_menu(Ui& ui) {
    for (const Id id : bar(ui).before)
        if (ui.overlay_open(id)) return id;
    return 0;
}

void switch_menu(Ui& ui, Id from, Id to) {
    if (from == to) return;
    ui.close_overlay(from);
    open_popup(ui, to);
}

void step_menu(Ui& ui, Id from, size_t by) {
    const std::vector<Id>& titles = bar(ui).before;
    const auto at = std::find(titles.begin(), titles.end(), from);
    if (at == titles.end()) return;
    switch_menu(ui, from, titles[(size_t(at - titles.begin()) + by) % titles.size()]);
}

}  // namespace

Scope menu_bar(Ui& ui) {
    BarState& b = bar(ui);
    b.before = std::move(b.now);
    b.now.clear();
    const Rect area = ui.allocate_rest();
    b.rect = area;
    b.f10 = ui.take_key(Key::f10);
    ui.begin_row(area, 0);
    return Scope(ui, [](Ui& u) { u.end_layout(); });
}

Scope menu(Ui& ui, std::string_view title) {
    const Theme& t = ui.theme;
    const Id id = ui.make_id(title);
    BarState& b = bar(ui);
    b.now.push_back(id);
    Rect place = ui.allocate(
        {ui.text().measure(visible_label(title), ui.style()) + ui.px(20), ui.px(t.control_height)});
    const Id open = open_menu(ui);
    // While a menu is open the titles stay reachable: moving along them switches, a press closes.
    if (open != 0) ui.begin_raised();
    const Rect shape{place.x, std::round(place.center().y - ui.px(13)), place.w, ui.px(26)};
    const Response r = ui.interact(id ^ 1, shape, Sense::drag);
    if (open != 0) ui.end_raised();

    if (r.pressed) {
        ui.release_capture();
        if (open == id)
            ui.close_overlay(id);
        else if (open != 0)
            switch_menu(ui, open, id);
        else
            open_popup(ui, id);
    } else if (open != 0 && open != id && r.hovered && ui.mouse_moved()) {
        switch_menu(ui, open, id);
    }
    if (b.f10 && b.now.size() == 1 && open == 0) open_popup(ui, id);

    const bool lit = ui.overlay_open(id);
    if (lit || r.hovered) ui.draw().rect(shape, lit ? t.button_hover : t.hover, ui.px(t.radius));
    ui.draw_label(shape, visible_label(title), ui.style(), t.text, Ui::Align::center);
    if (!lit) return {};
    Scope scope = popup(ui, id, {.anchor = shape, .min_width = ui.px(180), .keep_open = b.rect});
    if (scope && ui.overlay_open(id)) {
        if (ui.take_key(Key::right))
            step_menu(ui, id, 1);
        else if (ui.take_key(Key::left))
            step_menu(ui, id, b.before.size() - 1);
    }
    return scope;
}

Edit combo(Ui& ui, std::string_view name, int& selected, std::span<const std::string_view> choices) {
    const Theme& t = ui.theme;
    const Rect place = labelled(ui, name, 160);
    const Id id = ui.make_id(name);
    const Response r = ui.interact(id, place, Sense::click);
    const int count = int(choices.size());
    Edit result;
    const auto choose = [&](int index) {
        if (index < 0 || index >= count || index == selected) return;
        selected = index;
        result = {true, true};
    };
    if (r.focused && !ui.overlay_open(id)) {
        while (ui.take_key(Key::down)) choose(selected + 1);
        while (ui.take_key(Key::up)) choose(selected - 1);
    }
    draw_field(ui, r);
    const Rect inner = place.inset(ui.px(8), 0);
    const Color ink = ui.disabled() ? t.text_disabled : t.text;
    if (selected >= 0 && selected < count)
        ui.draw_label({inner.x, inner.y, inner.w - ui.px(16), inner.h}, choices[size_t(selected)], ui.style(),
                      ink);
    ui.draw().icon(ui.text(), Icon::chevron_down, {inner.right() - ui.px(5), inner.center().y}, ui.px(14),
                   t.text_dim);
    ui.draw_focus_ring(r, ui.px(t.radius));

    if (r.pressed || (r.clicked && !r.released)) {
        if (r.pressed) ui.release_capture();
        open_popup(ui, id);
    }
    if (auto list = popup(ui, id, {.anchor = place, .min_width = place.w, .selected = selected})) {
        for (int i = 0; i < count; ++i)
            if (popup_item(ui, {.label = choices[size_t(i)], .checked = i == selected})) choose(i);
    }
    return result;
}

}  // namespace loam::ui
