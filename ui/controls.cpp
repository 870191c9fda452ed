#include "ui/controls.h"

#include <cmath>

namespace loam::ui {
namespace {

Color tone_color(const Theme& t, Tone tone) {
    switch (tone) {
        case Tone::dim:
            return t.text_dim;
        case Tone::error:
            return t.error;
        case Tone::warning:
            return t.warning;
        case Tone::success:
            return t.success;
        case Tone::normal:
            break;
    }
    return t.text;
}

Color enabled_text(const Ui& ui) {
    return ui.disabled() ? ui.theme.text_disabled : ui.theme.text;
}

}  // namespace

void label(Ui& ui, std::string_view text, Tone tone, Ui::Align align) {
    const Rect r = ui.allocate({ui.text().measure(text, ui.style()), ui.px(20)});
    ui.draw_label(r, text, ui.style(), ui.disabled() ? ui.theme.text_disabled : tone_color(ui.theme, tone),
                  align);
}

void heading(Ui& ui, std::string_view text) {
    const TextStyle style = ui.style(Weight::semibold);
    ui.draw_label(ui.allocate({ui.text().measure(text, style), ui.px(24)}), text, style, ui.theme.text);
}

void paragraph(Ui& ui, std::string_view text, Tone tone) {
    const float width = ui.remaining().w, line_height = ui.px(18);
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        std::string_view line = text.substr(0, text.find('\n'));
        while (ui.text().measure(line, ui.style()) > width) {
            const size_t space = line.rfind(' ');
            if (space == std::string_view::npos || space == 0) break;  // one word too long: ellipsis
            line = line.substr(0, space);
        }
        lines.push_back(line);
        text.remove_prefix(line.size());
        if (!text.empty()) text.remove_prefix(1);  // the space or line break
    }
    Rect place = ui.allocate({width, line_height * float(lines.size())});
    for (const std::string_view line : lines)
        ui.draw_label(cut(place, Edge::top, line_height), line, ui.style(), tone_color(ui.theme, tone));
}

void separator(Ui& ui) {
    const Rect r = ui.allocate({ui.px(1), ui.px(9)});
    if (ui.in_column())
        ui.draw().rect({r.x, r.y + std::floor(r.h * 0.5f), r.w, ui.px(1)}, ui.theme.popup_edge.faded(0.7f));
    else
        ui.draw().rect({r.x, r.y + std::round(r.h * 0.2f), ui.px(1), std::round(r.h * 0.6f)},
                       ui.theme.popup_edge);
}

bool button(Ui& ui, std::string_view name, const ButtonDesc& desc) {
    const Theme& t = ui.theme;
    const std::string_view shown = visible_label(name);
    const float text_width = ui.text().measure(shown, ui.style(Weight::medium));
    const float icon = desc.icon == Icon::none ? 0 : ui.px(16) + (shown.empty() ? 0 : ui.px(6));
    const Rect place = ui.allocate({text_width + icon + ui.px(24), ui.px(t.control_height)});
    const Response r = ui.interact(ui.make_id(name), place, Sense::click);

    Color fill = desc.primary ? t.accent : t.button;
    if (r.hovered) fill = desc.primary ? t.accent_hover : t.button_hover;
    if (r.held && r.hovered) fill = desc.primary ? t.accent : t.button_held;
    Color ink = desc.primary ? t.accent_text : t.text;
    if (ui.disabled()) fill = t.button.faded(0.5f), ink = t.text_disabled;
    ui.draw().rect(place, fill, ui.px(t.radius));
    const float x = std::max(place.x + ui.px(8), std::round(place.center().x - (text_width + icon) * 0.5f));
    if (icon > 0) ui.draw().icon(ui.text(), desc.icon, {x + ui.px(8), place.center().y}, ui.px(16), ink);
    ui.draw_label({x + icon, place.y, place.right() - ui.px(6) - x - icon, place.h}, shown,
                  ui.style(Weight::medium), ink);
    ui.draw_focus_ring(r, ui.px(t.radius));
    ui.tooltip(r, desc.tooltip, desc.shortcut);
    return r.clicked;
}

bool icon_button(Ui& ui, std::string_view name, const IconButtonDesc& desc) {
    const Theme& t = ui.theme;
    const float size = ui.px(desc.size > 0 ? desc.size : t.tool_button);
    Rect place = ui.allocate({size, size});
    // Square and centred, whatever the cell.
    place = {place.x + std::floor(std::max(0.0f, place.w - size) * 0.5f),
             place.y + std::floor((place.h - size) * 0.5f), std::min(size, place.w), size};
    const Response r = ui.interact(ui.make_id(name), place, Sense::click);
    if (desc.toggled) ui.draw().rect(place, t.accent_soft, ui.px(t.radius));
    if (r.hovered && !(r.held && desc.toggled))
        ui.draw().rect(place, t.hover.faded(r.held ? 1.8f : 1.0f), ui.px(t.radius));
    const Color ink = ui.disabled()  ? t.text_disabled
                      : desc.toggled ? t.accent_text
                      : r.hovered    ? t.text
                                     : t.text.faded(0.86f);
    ui.draw().icon(ui.text(), desc.icon, place.center(),
                   ui.px(std::min(t.icon_size, (desc.size > 0 ? desc.size : 99) - 8)), ink);
    ui.draw_focus_ring(r, ui.px(t.radius));
    ui.tooltip(r, desc.tooltip, desc.shortcut);
    return r.clicked;
}

bool checkbox(Ui& ui, std::string_view name, bool& value) {
    const Theme& t = ui.theme;
    const std::string_view shown = visible_label(name);
    const float box = ui.px(16);
    Rect place =
        ui.allocate({box + ui.px(8) + ui.text().measure(shown, ui.style()), ui.px(t.control_height)});
    const float used = std::min(
        place.w, box + (shown.empty() ? 0 : ui.px(8) + std::ceil(ui.text().measure(shown, ui.style()))));
    place.w = used;
    const Response r = ui.interact(ui.make_id(name), place, Sense::click);
    if (r.clicked) value = !value;

    const Rect square{place.x, std::round(place.center().y - box * 0.5f), box, box};
    const Color fill =
        value ? (r.hovered ? t.accent_hover : t.accent) : (r.hovered ? t.field_hover : t.field);
    const Color edge = value ? fill : r.hovered ? t.field_edge_hover : t.field_edge;
    const float fade = ui.disabled() ? 0.4f : 1.0f;
    ui.draw().rect(square, fill.faded(fade), ui.px(3), edge.faded(fade), ui.px(1));
    if (value) ui.draw().icon(ui.text(), Icon::check, square.center(), ui.px(12), t.accent_text.faded(fade));
    ui.draw_label(
        {square.right() + ui.px(8), place.y, place.right() - square.right() - ui.px(8) + 1, place.h}, shown,
        ui.style(), enabled_text(ui));
    Response ring = r;
    ring.rect = square;
    ui.draw_focus_ring(ring, ui.px(3));
    return r.clicked;
}

void progress(Ui& ui, double fraction, std::string_view text) {
    const Theme& t = ui.theme;
    const Rect place = ui.allocate({ui.px(120), ui.px(text.empty() ? 12 : t.control_height)});
    const float height = ui.px(6);
    const float text_width =
        text.empty() ? 0 : std::min(place.w * 0.6f, ui.text().measure(text, ui.small_style()) + ui.px(8));
    const Rect bar{place.x, std::round(place.center().y - height * 0.5f), place.w - text_width, height};
    ui.draw().rect(bar, t.field, height * 0.5f);
    ui.draw().push_clip(bar);
    if (fraction >= 0) {
        const float w = std::round(bar.w * float(std::min(1.0, fraction)));
        if (w > 0) ui.draw().rect({bar.x, bar.y, std::max(w, height), height}, t.accent, height * 0.5f);
    } else {
        constexpr double kPeriod_s = 1.6;
        const double phase = std::fmod(ui.time_s(), kPeriod_s) / kPeriod_s;
        const float w = bar.w * 0.3f;
        ui.draw().rect({bar.x - w + (bar.w + w) * float(phase), bar.y, w, height}, t.accent, height * 0.5f);
        ui.wake_at(ui.time_s() + 1.0 / 30.0);
    }
    ui.draw().pop_clip();
    ui.draw_label({bar.right(), place.y, text_width, place.h}, text, ui.small_style(), t.text_dim,
                  Ui::Align::right);
}

void picture(Ui& ui, TextureId texture, float height, const Rect& uv) {
    const Rect place = ui.allocate({ui.px(height), ui.px(height)});
    ui.draw().image(place, texture, uv, {255, 255, 255, 255}, ui.px(ui.theme.radius));
}

Rect labelled(Ui& ui, std::string_view name, float wanted_width) {
    const std::string_view shown = visible_label(name);
    const float height = ui.px(ui.theme.control_height);
    if (shown.empty() || !ui.in_column()) return ui.allocate({ui.px(wanted_width), height});
    Rect rest = ui.allocate({ui.px(wanted_width), height});
    const Rect left = cut(rest, Edge::left, std::round(rest.w * ui.theme.label_share));
    ui.draw_label({left.x, left.y, left.w - ui.px(8), left.h}, shown, ui.style(),
                  ui.disabled() ? ui.theme.text_disabled : ui.theme.text_dim);
    return rest;
}

Scope property(Ui& ui, std::string_view name) {
    return ui.row_in(labelled(ui, name));
}

void draw_field(Ui& ui, const Response& r) {
    const Theme& t = ui.theme;
    const bool over = r.hovered && !ui.disabled();
    ui.draw().rect(r.rect, over ? t.field_hover : t.field, ui.px(t.radius),
                   (over ? t.field_edge_hover : t.field_edge).faded(ui.disabled() ? 0.5f : 1.0f), ui.px(1));
}

}  // namespace loam::ui
