// One line of text: caret, selection, clipboard, undo.
#pragma once

#include <string>

#include "ui/controls.h"
#include "ui/text_edit.h"

namespace loam::ui {

struct TextFieldDesc {
    std::string_view placeholder{};
    Icon icon = Icon::none;
    size_t max_bytes = 4096;
};
// `value` follows every key; Escape restores what it was when the field got the focus.
Edit text_field(Ui& ui, std::string_view label, std::string& value, const TextFieldDesc& desc = {});

// The inside of a field that is being edited, for widgets of your own: handles keys and mouse and draws.
struct LineState {
    TextEdit edit;
    float scroll_px = 0;
};
struct LineResult {
    bool changed = false, accepted = false, cancelled = false;
};
LineResult edit_line(Ui& ui, const Response& field, const Rect& area, LineState& line);

}  // namespace loam::ui
