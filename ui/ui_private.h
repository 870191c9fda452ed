// Shared by the parts of the context (ui.cpp, ui_layout.cpp, ui_overlay.cpp); not for widgets.
#pragma once

#include "ui/ui.h"

namespace loam::ui {

struct RowMemory {
    std::vector<float> wanted;  // px, per cell, of the frame before
};
struct SpringMemory {
    float width = 0;  // px behind the spring in the frame before
};

struct Ui::Layout {
    Rect area{};
    bool is_row = false;
    float gap = 0;
    float cursor = 0;  // where the next widget starts
    float end = 0;     // where the last one ended
    std::vector<Extent> cells;
    std::vector<float> wanted;
    size_t next = 0;
    Id memory = 0, spring_memory = 0;
    float spring_start = 0;
    int serial = 0;
};

}  // namespace loam::ui
