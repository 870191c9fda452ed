// Menu bar with pull-down menus, and combo boxes.
//
//     if (auto bar = menu_bar(ui)) {
//         if (auto file = menu(ui, "File")) {
//             if (menu_item(ui, {.label = "Save", .shortcut = shortcuts.label("save")})) save();
//         }
//     }
#pragma once

#include <span>

#include "ui/controls.h"
#include "ui/popup.h"

namespace loam::ui {

[[nodiscard]] Scope menu_bar(Ui& ui);  // in a top panel; F10 opens its first menu
[[nodiscard]] Scope menu(Ui& ui, std::string_view title);
inline bool menu_item(Ui& ui, const PopupItem& item) {
    return popup_item(ui, item);
}
inline void menu_separator(Ui& ui) {
    popup_separator(ui);
}

Edit combo(Ui& ui, std::string_view label, int& selected, std::span<const std::string_view> choices);

}  // namespace loam::ui
