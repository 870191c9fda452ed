// The region where the application draws its own scene. The interface draws nothing there, unless a picture
// is given.
#pragma once

#include "ui/ui.h"

namespace loam::ui {

struct ViewportResponse {
    Rect rect{};  // physical px in the window
    bool hovered = false, focused = false;
    bool pressed = false, held = false, released = false, double_clicked = false;
    MouseButton button = MouseButton::left;  // of those; the press captures all until its release
    Vec2 mouse{};                              // relative to the region
    Vec2 drag{};                               // while held
    float wheel = 0;                         // notches
};
// Takes what the panels left of the window.
ViewportResponse viewport(Ui& ui, std::string_view name, TextureId picture = 0);

}  // namespace loam::ui
