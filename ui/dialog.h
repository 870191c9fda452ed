// Modal dialogs. `open_dialog` may be called from anywhere; the dialog itself is built in every frame after
// the panels.
//
//     if (auto d = dialog(ui, "Delete layer?")) {
//         paragraph(ui, "The layer is still painted on 12 pages.");
//         switch (dialog_buttons(ui, {"Cancel", "Delete"})) { case 1: remove(); }
//     }
#pragma once

#include <initializer_list>

#include "ui/controls.h"

namespace loam::ui {

void open_dialog(Ui& ui, std::string_view title);
void close_dialog(Ui& ui, std::string_view title);
[[nodiscard]] bool dialog_open(const Ui& ui, std::string_view title);
// Escape closes it. Width in logical px; the height follows the content.
[[nodiscard]] Scope dialog(Ui& ui, std::string_view title, float width = 400);
// Right-aligned; the last one is the primary. Returns the index pressed (the dialog closes), else -1.
int dialog_buttons(Ui& ui, std::initializer_list<std::string_view> labels);

}  // namespace loam::ui
