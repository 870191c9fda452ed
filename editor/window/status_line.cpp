#include <cmath>

#include "editor/window/panels.h"

namespace loam::window {

namespace {

// A field of fixed width: numbers that change must not push the others about.
void field(ui::Ui& ui, ui::Rect& row, float width, const std::string& text, ui::Color color) {
    ui.draw_label(ui::cut(row, ui::Edge::left, ui.px(width)), text, ui.style(), color);
}

void field_at_end(ui::Ui& ui, ui::Rect& row, float width, const std::string& text, ui::Color color) {
    ui.draw_label(ui::cut(row, ui::Edge::right, ui.px(width)), text, ui.style(), color, ui::Ui::Align::right);
}

} // namespace

void build_status_line(App& app, ui::Ui& ui) {
    auto panel = ui::panel(ui, "status", {.edge = ui::Edge::bottom, .size = 26, .horizontal = true, .padding = 0});
    ui::Rect row = ui.allocate_rest().inset(ui.px(12), 0);
    const ui::Theme& theme = ui.theme;
    const FrameInfo& frame = app.frame;

    field_at_end(ui, row, 118, frame.resting ? fmt::format("resting · {}", frame.redraws)
                                             : fmt::format("drawing · {}", frame.redraws), theme.text_dim);
    field_at_end(ui, row, 92, fmt::format("{} pending", frame.pages_pending),
                 frame.pages_pending > 0 ? theme.text : theme.text_dim);
    field_at_end(ui, row, 62, fmt::format("{:.0f} %", frame.render_scale * 100), theme.text_dim);
    field_at_end(ui, row, 72, fmt::format("{:.1f} ms", frame.frame_ms), theme.text_dim);

    if (const ImportJob* import = app.import()) {
        const ImportJob::Stand stand = import->stand();
        auto area = ui.column_in(ui::cut(row, ui::Edge::right, ui.px(500)).inset(0, ui.px(2)), 0);
        auto columns = ui.row({ui::flex(), ui::fixed(120), ui::fixed(70)}, 22);
        ui::label(ui,
                  stand.what.empty() ? import->title() : fmt::format("{}: {}", import->title(), stand.what));
        ui::progress(ui, stand.share);
        if (ui::button(ui, "Cancel")) app.cancel_import();
    }

    if (const auto& at = app.cursor_ground()) {
        const bool inside = app.session.document().bounds().contains(at->x, at->y);
        field(ui, row, 92, fmt::format("E {:.2f}", at->x), theme.text);
        field(ui, row, 92, fmt::format("N {:.2f}", at->y), theme.text);
        field(ui, row, 98, fmt::format("{:.2f} m", at->z), theme.text);
        const auto normal = app.session.normal(at->x, at->y);
        const double slope = normal ? std::acos(std::clamp(normal->z, -1.0, 1.0)) * 180 / M_PI : 0;
        field(ui, row, 48, fmt::format("{:.0f}°", slope), theme.text_dim);
        field(ui, row, 96, inside ? app.layer_name_at(at->x, at->y) : std::string("off the map"), theme.text_dim);
    } else if (app.flying()) {
        field(ui, row, 240, fmt::format("flying {:.1f} m/s", app.camera.speed_m_s()), theme.text_dim);
    } else {
        field(ui, row, 12, "", theme.text);
    }
    ui.draw_label(row, app.message(), ui.style(), theme.text_dim);
}

void build_shader_errors(App& app, ui::Ui& ui) {
    if (app.shader_errors.empty()) return;
    auto panel = ui::panel(ui, "shader errors", {.edge = ui::Edge::bottom, .size = 140, .resizable = true, .scroll = true});
    ui::heading(ui, "Shaders that do not compile; the pipelines before stay in use");
    for (const std::string& text : app.shader_errors) ui::paragraph(ui, text, ui::Tone::error);
}

} // namespace loam::window
