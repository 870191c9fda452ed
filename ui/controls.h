// Simple controls. A label that is visible ("Radius", not "##radius") makes slider, checkbox, combo and text
// field property rows: the label at the left, the control in the rest.
#pragma once

#include <string_view>

#include "ui/ui.h"

namespace loam::ui {

// What an edit did in this frame. `finished` ends a run of changes (release, Enter, focus lost): one step of
// undo.
struct Edit {
    bool changed = false;
    bool finished = false;
    explicit operator bool() const { return changed; }
};

enum class Tone { normal, dim, error, warning, success };
void label(Ui& ui, std::string_view text, Tone tone = Tone::normal, Ui::Align align = Ui::Align::left);
void heading(Ui& ui, std::string_view text);
// As many lines as needed at the width there is; "\n" breaks.
void paragraph(Ui& ui, std::string_view text, Tone tone = Tone::normal);
void separator(Ui& ui);

struct ButtonDesc {
    Icon icon = Icon::none;
    bool primary = false;
    std::string_view tooltip{}, shortcut{};
};
bool button(Ui& ui, std::string_view label, const ButtonDesc& desc = {});

// A square button; `toggled` shows a tool or mode in use. The name is its id.
struct IconButtonDesc {
    Icon icon = Icon::none;
    bool toggled = false;
    std::string_view tooltip{}, shortcut{};
    float size = 0;  // logical; 0: the theme's tool button
};
bool icon_button(Ui& ui, std::string_view name, const IconButtonDesc& desc);

bool checkbox(Ui& ui, std::string_view label, bool& value);
// 0 … 1; below 0: running, length unknown.
void progress(Ui& ui, double fraction, std::string_view text = {});
void picture(Ui& ui, TextureId texture, float height, const Rect& uv = {0, 0, 1, 1});

// A row with a label; what follows goes into the scope.
[[nodiscard]] Scope property(Ui& ui, std::string_view label);
// The same for one control: its place.
[[nodiscard]] Rect labelled(Ui& ui, std::string_view label, float wanted_width = 120);
// Background of what holds a value.
void draw_field(Ui& ui, const Response& r);

}  // namespace loam::ui
