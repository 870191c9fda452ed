#include "ui/tiles.h"

#include <cmath>

namespace loam::ui {

TileResult tile_grid(Ui& ui, std::string_view name, std::span<const Tile> tiles, int& selected,
                     const TileGridDesc& desc) {
    const Theme& t = ui.theme;
    TileResult result;
    const int count = int(tiles.size());
    const float width = ui.remaining().w, gap = ui.px(8), caption = ui.px(18);
    const int columns = std::max(1, int((width + gap) / (ui.px(desc.picture) + gap)));
    const float side = std::floor((width - gap * float(columns - 1)) / float(columns));
    const int rows = (count + columns - 1) / columns;
    if (count == 0 || side < 1) return result;
    const Rect area = ui.allocate({width, float(rows) * (side + caption) + float(rows - 1) * ui.px(4)});
    const Id id = ui.make_id(name);

    // One stop for Tab; arrows walk inside.
    const Response grid = ui.interact(id, area, Sense::click);
    const int before = selected;
    const auto go = [&](int to) {
        if (to >= 0 && to < count) selected = to;
    };
    if (grid.focused) {
        while (ui.take_key(Key::right)) go(selected + 1);
        while (ui.take_key(Key::left)) go(selected - 1);
        while (ui.take_key(Key::down)) go(selected < 0 ? 0 : selected + columns);
        while (ui.take_key(Key::up)) go(selected - columns);
    }
    for (int i = 0; i < count; ++i) {
        const Tile& tile = tiles[size_t(i)];
        const Rect cell{area.x + float(i % columns) * (side + gap),
                        area.y + float(i / columns) * (side + caption + ui.px(4)), side, side + caption};
        const Rect image{cell.x, cell.y, side, side};
        const bool over = grid.hovered && cell.contains(ui.mouse());
        if (over && grid.pressed) selected = i;
        if (over && grid.double_clicked) result.activated = i;
        if (tile.texture != 0)
            ui.draw().image(image, tile.texture, tile.uv, {255, 255, 255, 255}, ui.px(t.radius));
        else
            ui.draw().rect(image, tile.color, ui.px(t.radius));
        const bool chosen = i == selected;
        if (chosen) {
            ui.draw().rect(image, kTransparent, ui.px(t.radius), t.panel, ui.px(3));
            ui.draw().rect(image, kTransparent, ui.px(t.radius), t.accent, ui.px(2));
        } else if (over) {
            ui.draw().rect(image, kTransparent, ui.px(t.radius), t.text.faded(0.6f), ui.px(1));
        }
        if (chosen && grid.focus_visible)
            ui.draw_focus_ring({.rect = image.grown(ui.px(1)), .focus_visible = true}, ui.px(t.radius + 1));
        ui.draw_label({cell.x, image.bottom(), side, caption}, tile.caption, ui.small_style(),
                      chosen ? t.text : t.text_dim, Ui::Align::center);
        if (over) ui.tooltip({.id = id + uint64_t(i) + 1, .rect = image, .hovered = true}, tile.caption);
    }
    result.changed = selected != before;
    return result;
}

}  // namespace loam::ui
