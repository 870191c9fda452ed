#include "ui/panel.h"

#include <cmath>

namespace loam::ui {
namespace {

struct PanelSize {
    float logical = -1;
    float grab = 0;
};
struct OpenScroll {
    Id id;
    Rect view;
    float start_y;
};
struct Opened {
    std::vector<OpenScroll> scrolls;
    std::vector<bool> panel_scrolls;
};
constexpr Id kOpenedId = 0x0B5;

Opened& opened(Ui& ui) {
    return ui.state<Opened>(kOpenedId);
}

// Thumb and trough of a scroll bar; true when the offset changed.
void scroll_bar(Ui& ui, Id id, const Rect& view, float content_height, ScrollState& s) {
    const Theme& t = ui.theme;
    const float width = ui.px(t.scroll_bar_width);
    const Rect trough{view.right() - width, view.y, width, view.h};
    const float length = std::max(ui.px(24), std::round(view.h * view.h / content_height));
    const float travel = std::max(1.0f, view.h - length);
    const Rect thumb{trough.x, view.y + std::round(travel * s.offset / std::max(1.0f, s.limit)), width,
                     std::min(length, view.h)};
    const Response r = ui.interact(id ^ 2, trough, Sense::drag);
    if (r.pressed) s.grab = thumb.contains(ui.mouse()) ? ui.mouse().y - thumb.y : thumb.h * 0.5f;
    if (r.pressed || r.held) {
        const float wanted = std::clamp((ui.mouse().y - s.grab - view.y) / travel, 0.0f, 1.0f) * s.limit;
        if (wanted != s.offset) {
            s.offset = wanted;
            ui.request_redraw();
        }
    }
    const Rect shown = thumb.inset(std::round(width * 0.3f), ui.px(2));
    ui.draw().rect(shown, r.hovered || r.held ? t.scroll_bar_hover : t.scroll_bar, shown.w * 0.5f);
}

void begin_scroll(Ui& ui, Id id, const Rect& view, float gap) {
    ScrollState& s = ui.state<ScrollState>(id);
    Rect inside = view;
    if (s.limit > 0) cut(inside, Edge::right, ui.px(ui.theme.scroll_bar_width));
    ui.draw().push_clip(view);
    ui.push_id(id);
    opened(ui).scrolls.push_back({id, view, view.y - std::round(s.offset)});
    ui.begin_column({inside.x, view.y - std::round(s.offset), inside.w, inside.h}, gap);
}

void end_scroll(Ui& ui) {
    const OpenScroll o = opened(ui).scrolls.back();
    opened(ui).scrolls.pop_back();
    const float content_height = ui.content_end() - o.start_y;
    ui.end_layout();
    ui.pop_id();
    ScrollState& s = ui.state<ScrollState>(o.id);
    const float offset_before = s.offset, limit_before = s.limit;
    s.limit = std::max(0.0f, content_height - o.view.h);
    if (float notches = 0; s.limit > 0 && ui.take_wheel(o.view, notches)) s.offset -= notches * ui.px(48);
    if (const auto& target = ui.revealed()) {
        const float margin = ui.px(8);
        if (target->y - margin < o.view.y) s.offset -= o.view.y - target->y + margin;
        if (target->bottom() + margin > o.view.bottom())
            s.offset += target->bottom() + margin - o.view.bottom();
        ui.revealed().reset();
    }
    s.offset = std::clamp(s.offset, 0.0f, s.limit);
    if (s.offset != offset_before || (s.limit > 0) != (limit_before > 0)) ui.request_redraw();
    if (s.limit > 0) scroll_bar(ui, o.id, o.view, content_height, s);
    ui.draw().pop_clip();
}

void end_panel(Ui& ui) {
    const bool scrolls = opened(ui).panel_scrolls.back();
    opened(ui).panel_scrolls.pop_back();
    if (scrolls) {
        ui.space(ui.theme.padding * 0.5f);
        end_scroll(ui);
    } else {
        ui.end_layout();
    }
    ui.draw().pop_clip();
    ui.pop_id();
}

// The strip between a panel and the rest. Lies half over both.
float splitter(Ui& ui, Id id, Edge edge, const Rect& rect, const PanelDesc& desc, float size) {
    const bool across = edge == Edge::left || edge == Edge::right;
    const float grip = ui.px(ui.theme.splitter);
    Rect strip = rect;
    Rect inner = rect;
    const Edge far_edge = edge == Edge::left    ? Edge::right
                          : edge == Edge::right ? Edge::left
                          : edge == Edge::top   ? Edge::bottom
                                                : Edge::top;
    strip = cut(inner, far_edge, grip);
    const Response r = ui.interact(id ^ 1, strip, Sense::drag);
    PanelSize& s = ui.state<PanelSize>(id);
    const Vec2 m = ui.mouse();
    const float at = edge == Edge::left    ? m.x - rect.x
                     : edge == Edge::right ? rect.right() - m.x
                     : edge == Edge::top   ? m.y - rect.y
                                           : rect.bottom() - m.y;
    if (r.pressed) s.grab = size * ui.theme.scale - at;
    if (r.held && !r.pressed) {
        const float wanted = std::clamp((at + s.grab) / ui.theme.scale, desc.min_size, desc.max_size);
        if (wanted != size) ui.request_redraw();
        size = wanted;
    }
    if (r.hovered || r.held) {
        ui.set_cursor(across ? Cursor::resize_x : Cursor::resize_y);
        const float w = ui.px(2);
        Rect rest = rect;
        ui.draw().rect(cut(rest, far_edge, w), ui.theme.accent.faded(r.held ? 1.0f : 0.7f));
    }
    return size;
}

}  // namespace

Scope panel(Ui& ui, std::string_view name, const PanelDesc& desc) {
    const Theme& t = ui.theme;
    const Id id = ui.make_id(name);
    PanelSize& remembered = ui.state<PanelSize>(id);
    float size = desc.size;
    if (desc.resizable) {
        if (remembered.logical < 0) remembered.logical = desc.size;
        size = std::clamp(desc.stored_size ? *desc.stored_size : remembered.logical, desc.min_size,
                          desc.max_size);
    }
    const Rect rect = ui.dock(desc.edge, ui.px(size));
    ui.draw().rect(rect, t.panel);
    Rect inner = rect;
    // A hairline towards what comes after.
    const Edge far_edge = desc.edge == Edge::left    ? Edge::right
                          : desc.edge == Edge::right ? Edge::left
                          : desc.edge == Edge::top   ? Edge::bottom
                                                     : Edge::top;
    ui.draw().rect(cut(inner, far_edge, ui.px(1)), t.panel_edge);
    if (desc.resizable) {
        size = splitter(ui, id, desc.edge, rect, desc, size);
        remembered.logical = size;
        if (desc.stored_size) *desc.stored_size = size;
        cut(inner, far_edge, ui.px(t.splitter) - ui.px(1));
    }
    const float padding = ui.px(desc.padding >= 0 ? desc.padding : t.padding);
    ui.push_id(id);
    ui.draw().push_clip(rect);
    if (desc.scroll) {
        // The bar stands in the right padding.
        Rect view = inner.inset(padding, 0);
        view.w += std::max(0.0f, padding - ui.px(2));
        const Id scroll_id = ui.make_id("##scroll");
        begin_scroll(ui, scroll_id, view, desc.gap);
        ui.end_layout();
        const ScrollState& s = ui.state<ScrollState>(scroll_id);
        const float width = inner.w - 2 * padding;
        ui.begin_column({view.x, view.y - std::round(s.offset), width, view.h}, desc.gap);
        ui.space(std::max(0.0f, (desc.padding >= 0 ? desc.padding : t.padding) * 0.5f));
    } else if (desc.horizontal) {
        ui.begin_row(inner.inset(padding, 0), desc.gap);
    } else {
        ui.begin_column(inner.inset(padding), desc.gap);
    }
    opened(ui).panel_scrolls.push_back(desc.scroll);
    return Scope(ui, end_panel);
}

Scope scroll_area(Ui& ui, std::string_view name, float height) {
    const Rect view = height > 0 ? ui.allocate({ui.remaining().w, ui.px(height)}) : ui.allocate_rest();
    begin_scroll(ui, ui.make_id(name), view, -1);
    return Scope(ui, end_scroll);
}

ScrollState& scroll_state(Ui& ui, std::string_view name) {
    return ui.state<ScrollState>(ui.make_id(name));
}

Scope section(Ui& ui, std::string_view title, Section first) {
    struct State {
        bool known = false, open = false;
    };
    const Theme& t = ui.theme;
    const Id id = ui.make_id(title);
    State& s = ui.state<State>(id);
    if (!s.known) s = {true, first == Section::open};
    const Rect place = ui.allocate({0, ui.px(t.section_height)});
    const Response r = ui.interact(id, place, Sense::click);
    if (r.clicked) {
        s.open = !s.open;
        ui.request_redraw();
    }
    ui.draw().rect(place, r.hovered ? t.button : t.header, ui.px(t.radius));
    ui.draw().icon(ui.text(), s.open ? Icon::chevron_down : Icon::chevron_right,
                   {place.x + ui.px(12), place.center().y}, ui.px(14), t.text_dim);
    ui.draw_label({place.x + ui.px(24), place.y, place.w - ui.px(28), place.h}, visible_label(title),
                  ui.style(Weight::semibold), t.text);
    ui.draw_focus_ring(r, ui.px(t.radius));
    if (!s.open) return {};
    ui.push_id(id);
    ui.space(2);
    return Scope(ui, [](Ui& u) {
        u.space(8);
        u.pop_id();
    });
}

}  // namespace loam::ui
