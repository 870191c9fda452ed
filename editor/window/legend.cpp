// What the colours of a debug view mean, over the foot of the picture. The colours are the shader's own
// (shaders/frame/debug_io.h).
#include <array>
#include <cmath>

#include "editor/window/panels.h"
#include "runtime/frame/debug_views.h"
#include "shaders/frame/debug_io.h"

namespace loam::window {

namespace {

struct Swatch {
    glm::vec3 color{0};
    std::string label;
};

std::vector<Swatch> steps() {
    std::vector<Swatch> list;
    for (int i = 0; i < kDebugStepCount; ++i) list.push_back({shared::debug_step_color(i), fmt::format("{}", i)});
    return list;
}

// Of a logarithmic scale that ends at `most`.
std::vector<Swatch> ramp(float most, std::initializer_list<int> values) {
    std::vector<Swatch> list;
    for (const int v : values)
        list.push_back({shared::debug_ramp_color(shared::debug_log_share(float(v), most)), fmt::format("{}", v)});
    return list;
}

std::vector<Swatch> swatches(DebugScale scale) {
    switch (scale) {
        case DebugScale::none: return {};
        case DebugScale::steps: return steps();
        case DebugScale::frames: return ramp(kDebugMostFrames, {0, 1, 3, 15, 63, 255});
        case DebugScale::cells: return ramp(kDebugMostCells, {1, 15, 255, 4095, 65535});
        case DebugScale::dirt: return {{shared::debug_ramp_color(1), "now"}};
        case DebugScale::pages: return ramp(kDebugMostPages, {0, 1, 2, 4, 8, 16});
        case DebugScale::decals: return ramp(kDebugMostDecals, {1, 3, 7, 15, 31, 63});
    }
    return {};
}

ui::Color to_color(glm::vec3 c) {
    const auto byte = [](float v) { return uint8_t(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
    return {byte(c.r), byte(c.g), byte(c.b), 255};
}

} // namespace

void draw_legend(App& app, ui::Ui& ui, const ui::Rect& viewport) {
    if (app.view.debug == DebugView::none) return;
    const DebugViewInfo& info = debug_view_info(app.view.debug);
    const std::string words = *info.legend ? fmt::format("{}: {}", info.title, info.legend) : info.title;
    const std::vector<Swatch> colors = swatches(info.scale);
    const float pad = ui.px(10), line = ui.px(22), box = ui.px(14);
    float colors_width = 0;
    for (const Swatch& s : colors) colors_width += box + ui.px(5) + ui.text().measure(s.label, ui.style()) + ui.px(12);
    const float width = std::min(std::max(ui.text().measure(words, ui.style()), colors_width) + 2 * pad + ui.px(4),
                                 viewport.w - 2 * pad);
    const float height = line * (colors.empty() ? 1 : 2) + pad;
    const ui::Rect panel{std::round(viewport.x + pad), std::round(viewport.bottom() - height - pad), width, height};
    ui.draw().push_clip(viewport);
    ui.draw().rect(panel, ui::Color::hex(0x15171a, 215), ui.px(ui.theme.radius));
    ui::Rect rows = panel.inset(pad, pad / 2);
    ui.draw_label(ui::cut(rows, ui::Edge::top, line), words, ui.style(), ui.theme.text);
    ui::Rect row = ui::cut(rows, ui::Edge::top, line);
    for (const Swatch& s : colors) {
        const ui::Rect at = ui::cut(row, ui::Edge::left, box);
        ui.draw().rect({at.x, std::round(at.center().y - box / 2), box, box}, to_color(s.color), ui.px(2));
        ui::cut(row, ui::Edge::left, ui.px(5));
        ui.draw_label(ui::cut(row, ui::Edge::left, ui.text().measure(s.label, ui.style()) + ui.px(12)), s.label, ui.style(),
                      ui.theme.text_dim);
    }
    ui.draw().pop_clip();
}

} // namespace loam::window
