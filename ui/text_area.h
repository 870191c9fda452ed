// Many lines of text: caret, selection, clipboard, undo, line numbers, marks at lines. For code: one width a
// letter.
#pragma once

#include <span>
#include <string>

#include "ui/controls.h"

namespace loam::ui {

struct TextAreaMark {
    int line = 1;  // from 1
    std::string_view says{};
};
struct TextAreaDesc {
    std::span<const TextAreaMark> marks{};  // lines with something wrong: a red bar, said on hovering
    size_t max_bytes = 65'536;
};
// Takes all the place that is left. `value` follows every key; Escape gives the keyboard back.
Edit text_area(Ui& ui, std::string_view name, std::string& value, const TextAreaDesc& desc = {});

}  // namespace loam::ui
