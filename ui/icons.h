// Icons drawn from strokes on a grid of 20 × 20. They are rasterised once a size into the glyph atlas, so
// that an icon is one quad and crossing strokes do not darken each other.
#pragma once

#include <cstdint>
#include <vector>

namespace loam::ui {

// clang-format off
enum class Icon : uint8_t {
    none, raise, lower, smooth, flatten, noise, paint, crater, footprints, decal, road, stamp, cutout, event, undo, redo, save, open, camera, layers, eye,
    eye_off, search, settings, play, stop, to_start, plus, minus, trash, check, cross, chevron_right, chevron_down, sun, info,
    warning, grid, count
};
// clang-format on

// Square coverage picture of size_px².
[[nodiscard]] std::vector<uint8_t> rasterise_icon(Icon icon, int size_px);

}  // namespace loam::ui
