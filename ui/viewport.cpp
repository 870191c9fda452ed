#include "ui/viewport.h"

namespace loam::ui {

ViewportResponse viewport(Ui& ui, std::string_view name, TextureId picture) {
    const Rect rect = ui.dock_rest();
    const Response r = ui.interact(ui.make_id(name), rect, Sense::any_button);
    ViewportResponse v{.rect = rect,
                       .hovered = r.hovered,
                       .focused = r.focused,
                       .pressed = r.pressed,
                       .held = r.held,
                       .released = r.released,
                       .double_clicked = r.double_clicked,
                       .button = r.button,
                       .mouse = ui.mouse() - Vec2{rect.x, rect.y},
                       .drag = r.drag};
    ui.take_wheel(rect, v.wheel);
    if (picture != 0) ui.draw().image(rect, picture);
    if (r.hovered || r.held) ui.set_viewport_hovered();
    return v;
}

}  // namespace loam::ui
