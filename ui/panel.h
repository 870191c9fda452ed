// Docked panels, scroll areas, collapsible sections.
#pragma once

#include "ui/ui.h"

namespace loam::ui {

struct PanelDesc {
    Edge edge = Edge::right;
    float size = 280;  // logical px; of a resizable panel only at first
    float min_size = 160, max_size = 640;
    bool resizable = false;
    bool scroll = false;
    bool horizontal = false;  // children in a row (bars)
    float padding = -1;       // logical; -1: the theme's
    float gap = -1;
    float* stored_size = nullptr;  // where the application keeps a resizable panel's size
};
// Panels are cut off the window in the order of the calls.
[[nodiscard]] Scope panel(Ui& ui, std::string_view name, const PanelDesc& desc);

// Wheel, draggable bar, and follows the keyboard focus. Height in logical px; 0: all that is left.
[[nodiscard]] Scope scroll_area(Ui& ui, std::string_view name, float height = 0);
// For tests and for code that scrolls: offset and its limit, px.
struct ScrollState {
    float offset = 0, limit = 0;
    float grab = 0;
};
[[nodiscard]] ScrollState& scroll_state(Ui& ui, std::string_view name);

enum class Section { open, closed };  // at first
[[nodiscard]] Scope section(Ui& ui, std::string_view title, Section first = Section::open);

}  // namespace loam::ui
