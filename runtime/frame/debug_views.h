// The debug views: what the command line and Python call them, what menus say, what their colours mean.
#pragma once

#include <span>

#include "runtime/frame/frame_settings.h"

namespace loam {

// What a view's colours count; the scales are those of shaders/frame/debug_io.h.
enum class DebugScale { none, steps, frames, cells, dirt, pages, decals };

struct DebugViewInfo {
    DebugView view;
    const char* name;    // --debug NAME
    const char* title;   // in menus
    const char* legend;  // one line; empty: the picture speaks for itself
    DebugScale scale = DebugScale::none;
};

[[nodiscard]] std::span<const DebugViewInfo> debug_views();  // in the order of DebugView
[[nodiscard]] const DebugViewInfo& debug_view_info(DebugView view);
// Drawn over the whole picture instead of it.
[[nodiscard]] bool debug_is_map(DebugView view);

}  // namespace loam
