// Lists that open over the interface: the common part of menus and combo boxes.
#pragma once

#include <string_view>

#include "ui/ui.h"

namespace loam::ui {

void open_popup(Ui& ui, Id id);

struct PopupDesc {
    Rect anchor{};          // opens below it, or above when there is no room
    float min_width = 0;  // px
    Rect keep_open{};       // a press here does not close it (the titles of a menu bar)
    int selected = -1;    // entry lit when it opens
};
// Only while the overlay is open.
[[nodiscard]] Scope popup(Ui& ui, Id id, const PopupDesc& desc);

struct PopupItem {
    std::string_view label{}, shortcut{};
    Icon icon = Icon::none;
    bool enabled = true;
    bool checked = false;
};
bool popup_item(Ui& ui, const PopupItem& item);  // chosen: the popup closes
void popup_separator(Ui& ui);

}  // namespace loam::ui
