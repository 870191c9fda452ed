// A grid of pictures with captions, one of them selected: palettes.
#pragma once

#include <span>

#include "ui/controls.h"

namespace loam::ui {

struct Tile {
    std::string_view caption{};
    TextureId texture = 0;  // 0: a field of `color`
    Rect uv{0, 0, 1, 1};
    Color color = Color::hex(0x808080);
};
struct TileResult {
    bool changed = false;
    int activated = -1;  // double-clicked
    explicit operator bool() const { return changed; }
};
struct TileGridDesc {
    float picture = 64;  // smallest picture side, logical px; columns share what is left
};
TileResult tile_grid(Ui& ui, std::string_view name, std::span<const Tile> tiles, int& selected,
                     const TileGridDesc& desc = {});

}  // namespace loam::ui
