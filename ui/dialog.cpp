#include "ui/dialog.h"

#include <cmath>

#include "runtime/base/check.h"

namespace loam::ui {
namespace {

struct DialogState {
    float height = 0;  // px, of the frame before
};
struct Building {
    Id id = 0;
    float top = 0;
};
constexpr Id kBuildingId = 0xD1A;

void end_dialog(Ui& ui) {
    Building& b = ui.state<Building>(kBuildingId);
    const float height = ui.content_end() + ui.px(16) - b.top;
    ui.end_layout();
    ui.draw().pop_clip();
    ui.pop_id();
    ui.end_overlay();
    float& remembered = ui.state<DialogState>(b.id).height;
    if (remembered != height) ui.request_redraw();
    remembered = height;
    b = {};
}

}  // namespace

void open_dialog(Ui& ui, std::string_view title) {
    ui.open_overlay(Ui::absolute_id(title));
}

void close_dialog(Ui& ui, std::string_view title) {
    ui.close_overlay(Ui::absolute_id(title));
}

bool dialog_open(const Ui& ui, std::string_view title) {
    return ui.overlay_open(Ui::absolute_id(title));
}

Scope dialog(Ui& ui, std::string_view title, float width) {
    const Id id = Ui::absolute_id(title);
    if (!ui.overlay_open(id)) return {};
    const Theme& t = ui.theme;
    LOAM_CHECK(ui.state<Building>(kBuildingId).id == 0,
               "a dialog inside another: build it after the first one's scope");
    const float height = ui.state<DialogState>(id).height;
    ui.begin_overlay(id);
    const Rect window = ui.window();
    const Rect r{std::round(window.center().x - ui.px(width) * 0.5f),
                 std::round(std::max(0.0f, (window.h - height) * 0.4f)), std::min(ui.px(width), window.w),
                 height};
    ui.draw().rect(window, t.veil);
    ui.draw().shadow({r.x, r.y + ui.px(6), r.w, r.h}, t.shadow, ui.px(t.popup_radius + 2), ui.px(24));
    ui.draw().rect(r, t.popup, ui.px(t.popup_radius + 2), t.popup_edge, ui.px(1));
    ui.draw().push_clip(r);
    ui.push_id(id);
    ui.state<Building>(kBuildingId) = {id, r.y};
    ui.begin_column({r.x + ui.px(20), r.y + ui.px(14), r.w - ui.px(40), std::max(r.h, ui.px(80))}, 8);
    const TextStyle style{Weight::semibold, (t.font_size + 2) * t.scale};
    ui.draw_label(ui.allocate({0, ui.px(24)}), visible_label(title), style, t.text);
    return Scope(ui, [](Ui& u) {
        // After the content, so that a field inside sees Escape first.
        const Id open = u.state<Building>(kBuildingId).id;
        if (u.take_key(Key::escape)) u.close_overlay(open);
        end_dialog(u);
    });
}

int dialog_buttons(Ui& ui, std::initializer_list<std::string_view> labels) {
    int pressed = -1, index = 0;
    ui.space(8);
    const auto row = ui.flow(28);
    ui.spring();
    for (const std::string_view label : labels) {
        const bool primary = index == int(labels.size()) - 1;
        if (button(ui, label, {.primary = primary})) pressed = index;
        ++index;
    }
    if (pressed >= 0) ui.close_overlay(ui.state<Building>(kBuildingId).id);
    return pressed;
}

}  // namespace loam::ui
