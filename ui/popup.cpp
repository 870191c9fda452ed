#include "ui/popup.h"

#include <cmath>

#include "runtime/base/check.h"

namespace loam::ui {
namespace {

struct PopupState {
    float width = 0, height = 0, scroll = 0;  // px; of the content in the frame before
    int selected = -1;
    std::vector<bool> enabled{};  // per item, of the frame before
    bool opened = false;
};
// The popup being built.
struct PopupBuild {
    Id id = 0;
    PopupState* state = nullptr;
    float width = 0, start_y = 0;
    std::vector<bool> enabled{};
    int chosen = -1;  // by Enter
};
constexpr Id kBuildId = 0xB01D;

PopupBuild& build(Ui& ui) {
    return ui.state<PopupBuild>(kBuildId);
}

void walk(PopupState& s, int step) {
    const int count = int(s.enabled.size());
    for (int tries = 0; tries < count; ++tries) {
        s.selected = s.selected < 0 && step < 0 ? count - 1 : (s.selected + step + count) % count;
        if (s.enabled[size_t(s.selected)]) return;
    }
    s.selected = -1;
}

void end_popup(Ui& ui) {
    PopupBuild& b = build(ui);
    PopupState& s = *b.state;
    const float height = ui.content_end() - b.start_y;
    if (s.width != b.width || s.height != height) ui.request_redraw();
    s.width = b.width;
    s.height = height;
    s.enabled = std::move(b.enabled);
    b = {};
    ui.draw().pop_clip();
    ui.pop_id();
    ui.end_overlay();
}

}  // namespace

void open_popup(Ui& ui, Id id) {
    ui.state<PopupState>(id) = {};
    ui.open_overlay(id);
}

Scope popup(Ui& ui, Id id, const PopupDesc& desc) {
    if (!ui.overlay_open(id)) return {};
    const Theme& t = ui.theme;
    PopupState& s = ui.state<PopupState>(id);
    LOAM_CHECK(build(ui).state == nullptr, "a popup inside another is not supported");
    ui.begin_overlay(id);
    if (!s.opened) {
        s.opened = true;
        s.selected = desc.selected;
    }
    const float pad = ui.px(4), width = std::max(desc.min_width, s.width + 2 * pad);
    const float whole = s.height + 2 * pad,
                room_below = ui.window().bottom() - desc.anchor.bottom() - ui.px(4);
    const float room_above = desc.anchor.y - ui.px(4);
    const bool below = whole <= room_below || room_below >= room_above;
    const float height = std::max(0.0f, std::min(whole, below ? room_below : room_above));
    Rect r{desc.anchor.x, below ? desc.anchor.bottom() + ui.px(2) : desc.anchor.y - height - ui.px(2), width,
           height};
    r.x = std::round(std::max(0.0f, std::min(r.x, ui.window().right() - r.w - ui.px(4))));

    const bool known = s.height > 0;  // else this frame measures and shows nothing
    const Vec2 m = ui.mouse();
    if (known && ui.on_top() && ui.pressed_button() && !ui.overlay_just_opened(id) && !r.contains(m) &&
        !desc.keep_open.contains(m))
        ui.close_overlay(id);
    if (ui.take_key(Key::escape)) ui.close_overlay(id);
    while (ui.take_key(Key::down)) walk(s, 1);
    while (ui.take_key(Key::up)) walk(s, -1);
    if (ui.take_key(Key::home)) s.selected = -1, walk(s, 1);
    if (ui.take_key(Key::end)) s.selected = -1, walk(s, -1);
    int chosen = -1;
    if (ui.take_key(Key::enter) || ui.take_key(Key::space)) chosen = s.selected;
    if (float notches = 0; ui.take_wheel(r, notches)) s.scroll -= notches * ui.px(t.menu_item_height * 2);
    s.scroll = std::clamp(s.scroll, 0.0f, std::max(0.0f, whole - height));

    if (known) {
        ui.draw().shadow({r.x, r.y + ui.px(4), r.w, r.h}, t.shadow, ui.px(t.popup_radius), ui.px(14));
        ui.draw().rect(r, t.popup, ui.px(t.popup_radius), t.popup_edge, ui.px(1));
    }
    const Rect inner = r.inset(pad);
    ui.draw().push_clip(known ? inner : Rect{});
    ui.push_id(id);
    PopupBuild& b = build(ui);
    b = {.id = id, .state = &s, .chosen = chosen};
    b.start_y = inner.y - std::round(s.scroll);
    ui.begin_column({inner.x, b.start_y, inner.w, inner.h}, 0);
    return Scope(ui, [](Ui& u) {
        end_popup(u);
        u.end_layout();
    });
}

bool popup_item(Ui& ui, const PopupItem& item) {
    const Theme& t = ui.theme;
    PopupBuild& b = build(ui);
    LOAM_CHECK(b.state != nullptr, "popup_item outside a popup");
    PopupState& s = *b.state;
    const int index = int(b.enabled.size());
    b.enabled.push_back(item.enabled);
    const float words = ui.text().measure(item.label, ui.style());
    const float keys = item.shortcut.empty() ? 0 : ui.text().measure(item.shortcut, ui.style()) + ui.px(32);
    b.width = std::max(b.width, std::ceil(ui.px(30) + words + keys + ui.px(14)));

    const Rect place = ui.allocate({0, ui.px(t.menu_item_height)});
    const bool over = ui.mouse_over(place) && item.enabled;
    if (over && (ui.mouse_moved() || ui.pressed_button())) s.selected = index;
    if (ui.mouse_over(place) && !item.enabled && ui.mouse_moved()) s.selected = -1;
    const bool lit = s.selected == index && item.enabled;
    // Entries take the release, so that one press can open, drag and choose.
    const bool clicked = over && ui.released_button() == MouseButton::left && !ui.overlay_just_opened(b.id);
    const bool chosen = clicked || (b.chosen == index && item.enabled);

    if (lit) ui.draw().rect(place, t.accent_soft, ui.px(t.radius));
    const Color ink = item.enabled ? t.text : t.text_disabled;
    const Vec2 mark{place.x + ui.px(15), place.center().y};
    if (item.checked)
        ui.draw().icon(ui.text(), Icon::check, mark, ui.px(14), item.enabled ? t.accent_hover : ink);
    else if (item.icon != Icon::none)
        ui.draw().icon(ui.text(), item.icon, mark, ui.px(16), item.enabled ? t.text_dim : ink);
    const Rect text{place.x + ui.px(30), place.y, place.w - ui.px(40), place.h};
    ui.draw_label(text, item.label, ui.style(), ink);
    ui.draw_label(text, item.shortcut, ui.style(), item.enabled ? t.text_dim : t.text_disabled,
                  Ui::Align::right);
    if (chosen) ui.close_overlay(b.id);
    return chosen;
}

void popup_separator(Ui& ui) {
    const Rect r = ui.allocate({0, ui.px(9)});
    ui.draw().rect({r.x + ui.px(6), r.y + ui.px(4), r.w - ui.px(12), ui.px(1)}, ui.theme.popup_edge);
}

}  // namespace loam::ui
