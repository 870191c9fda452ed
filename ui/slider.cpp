#include "ui/slider.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "ui/text_field.h"

namespace loam::ui {
namespace {

constexpr double kFine = 0.1;        // Shift
constexpr float kDragThreshold = 3;  // logical px: a click changes nothing
constexpr double kKeySteps = 100;    // arrow presses across a continuous slider

struct SliderState {
    bool editing = false, dragging = false, refused = false;
    float travelled = 0;
    double fraction = 0, before = 0;
    LineState line;
};

void begin_typing(Ui& ui, SliderState& s, double value, const SliderDesc& desc) {
    s.editing = true;
    s.dragging = s.refused = false;
    s.line = {};
    s.line.edit.max_bytes = 64;
    s.line.edit.set_text(format_number(value, desc.decimals));
    s.line.edit.select_all();
    ui.request_redraw();
}

bool drag(Ui& ui, const Response& r, SliderState& s, double& value, const SliderDesc& desc) {
    if (r.pressed) {
        s.before = value;
        s.fraction = slider_fraction(value, desc);
        s.travelled = 0;
        s.dragging = false;
    }
    if (!r.held || r.pressed) return false;
    s.travelled += std::abs(r.drag.x);
    if (!s.dragging && s.travelled < ui.px(kDragThreshold)) return false;
    if (!s.dragging) s.dragging = true;
    if (ui.take_key(Key::escape)) {
        value = s.before;
        s.dragging = false;
        ui.release_capture();
        return true;
    }
    const double speed = ui.mods().shift ? kFine : 1.0;
    s.fraction =
        std::clamp(s.fraction + double(r.drag.x) / double(std::max(1.0f, r.rect.w)) * speed, 0.0, 1.0);
    const double old = value;
    if (r.drag.x != 0) value = slider_value(s.fraction, desc);
    return value != old;
}

bool keys(Ui& ui, double& value, const SliderDesc& desc) {
    const double old = value;
    const Mods shift{.shift = true};
    const double fine = desc.step > 0 ? 1.0 : kFine;
    const auto nudge = [&](double count) {
        value = desc.step > 0 ? clamped(value + count * desc.step, desc)
                              : slider_value(slider_fraction(value, desc) + count / kKeySteps, desc);
    };
    while (ui.take_key(Key::right) || ui.take_key(Key::up)) nudge(1);
    while (ui.take_key(Key::left) || ui.take_key(Key::down)) nudge(-1);
    while (ui.take_key(Key::right, shift) || ui.take_key(Key::up, shift)) nudge(fine);
    while (ui.take_key(Key::left, shift) || ui.take_key(Key::down, shift)) nudge(-fine);
    while (ui.take_key(Key::page_up)) nudge(10);
    while (ui.take_key(Key::page_down)) nudge(-10);
    if (ui.take_key(Key::home)) value = clamped(desc.min, desc);
    if (ui.take_key(Key::end)) value = clamped(desc.max, desc);
    return value != old;
}

void draw_value(Ui& ui, const Response& r, double value, const SliderDesc& desc, bool held) {
    const Theme& t = ui.theme;
    draw_field(ui, r);
    const float edge = ui.px(1);
    const Rect inner = r.rect.inset(edge);
    const float filled = std::round(inner.w * float(slider_fraction(value, desc)));
    const float fade = ui.disabled() ? 0.4f : 1.0f;
    if (filled > 0) {
        ui.draw().push_clip({inner.x, inner.y, filled, inner.h});
        ui.draw().rect(inner, (r.hovered || held ? t.fill_hover : t.fill).faded(fade),
                       ui.px(t.radius) - edge);
        ui.draw().pop_clip();
        const float mark = std::clamp(inner.x + filled - ui.px(2), inner.x, inner.right() - ui.px(2));
        ui.draw().push_clip(inner);
        ui.draw().rect({mark, inner.y + ui.px(3), ui.px(2), inner.h - ui.px(6)}, t.accent.faded(fade),
                       ui.px(1));
        ui.draw().pop_clip();
    }
    Rect words = r.rect.inset(ui.px(8), 0);
    if (!desc.unit.empty()) {
        const Rect unit = cut(words, Edge::right, std::ceil(ui.text().measure(desc.unit, ui.style())));
        ui.draw_label(unit, desc.unit, ui.style(), ui.disabled() ? t.text_disabled : t.text_dim);
        cut(words, Edge::right, ui.px(4));
    }
    ui.draw_label(words, format_number(value, desc.decimals), ui.style(),
                  ui.disabled() ? t.text_disabled : t.text, Ui::Align::right);
}

}  // namespace

double clamped(double value, const SliderDesc& d) {
    if (std::isnan(value)) return d.min;
    value = std::clamp(value, d.min, std::max(d.min, d.max));
    if (d.step > 0) {
        value = d.min + std::round((value - d.min) / d.step) * d.step;
        if (value > d.max) value -= d.step;  // the range need not be a multiple of the step
        value = std::max(value, d.min);
    }
    return value;
}

double slider_fraction(double value, const SliderDesc& d) {
    value = clamped(value, d);
    if (!(d.max > d.min)) return 0;
    if (d.logarithmic && d.min > 0)
        return std::clamp(std::log(value / d.min) / std::log(d.max / d.min), 0.0, 1.0);
    return std::clamp((value - d.min) / (d.max - d.min), 0.0, 1.0);
}

double slider_value(double fraction, const SliderDesc& d) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    if (d.logarithmic && d.min > 0) return clamped(d.min * std::pow(d.max / d.min, fraction), d);
    return clamped(d.min + (d.max - d.min) * fraction, d);
}

std::optional<double> parse_number(std::string_view text, std::string_view unit) {
    const auto trim = [&text] {
        while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
        while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    };
    trim();
    if (!unit.empty() && text.ends_with(unit)) text.remove_suffix(unit.size());
    trim();
    std::string number(text);
    if (const size_t comma = number.find(',');
        comma != std::string::npos && number.find('.') == std::string::npos)
        number[comma] = '.';
    const char* begin = number.data();
    if (!number.empty() && number[0] == '+') ++begin;
    double value = 0;
    const auto [end, status] = std::from_chars(begin, number.data() + number.size(), value);
    if (status != std::errc() || end != number.data() + number.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::string format_number(double value, int decimals) {
    std::string s = fmt::format("{:.{}f}", value, std::clamp(decimals, 0, 9));
    if (s.find_first_not_of("-0.") == std::string::npos && s[0] == '-') s.erase(0, 1);  // no "-0.00"
    return s;
}

Edit slider(Ui& ui, std::string_view name, double& value, const SliderDesc& desc) {
    const Rect place = labelled(ui, name, 160);
    const Id id = ui.make_id(name);
    auto& s = ui.state<SliderState>(id);
    const Response r = ui.interact(id, place, s.editing ? Sense::edit : Sense::click);
    Edit result;
    // A value from outside that is no number or out of range is put right as soon as it is seen.
    if (const double good =
            std::isnan(value) ? desc.min : std::clamp(value, desc.min, std::max(desc.min, desc.max));
        !(good == value))
        value = good, result.changed = true;

    if (!s.editing) {
        const bool was_dragging = s.dragging;
        result.changed |= drag(ui, r, s, value, desc);
        if (was_dragging && !r.held) {
            s.dragging = false;
            result.finished = true;
        }
        if (r.double_clicked || (r.clicked && !r.released)) begin_typing(ui, s, value, desc);
        if (r.focused && !s.editing && keys(ui, value, desc)) result.changed = result.finished = true;
    }
    if (s.editing) {
        Response field = r;
        if (field.double_clicked) field.pressed = field.held = false;  // the click that opened it
        draw_field(ui, r);
        const LineResult line = edit_line(ui, field, place.inset(ui.px(8), 0), s.line);
        if (line.changed) s.refused = false;
        const bool leave = !r.focused;
        if (line.accepted || leave) {
            const auto typed = parse_number(s.line.edit.text(), desc.unit);
            if (typed) {
                const double now = clamped(*typed, desc);
                result.changed |= now != value;
                result.finished = true;
                value = now;
            }
            s.refused = !typed;
            s.editing = !typed && !leave;  // garbage: stays open, marked; left alone, the old value stands
        }
        if (line.cancelled) s.editing = false;
        if (!s.editing) ui.request_redraw();
        ui.draw().rect(place, kTransparent, ui.px(ui.theme.radius),
                       s.refused ? ui.theme.error : ui.theme.accent, ui.px(1));
        if (r.hovered) ui.set_cursor(Cursor::text);
        return result;
    }
    if (r.hovered || r.held) ui.set_cursor(Cursor::resize_x);
    draw_value(ui, r, value, desc, r.held);
    ui.draw_focus_ring(r, ui.px(ui.theme.radius));
    if (!r.held) ui.tooltip(r, desc.tooltip);
    return result;
}

Edit slider(Ui& ui, std::string_view name, float& value, const SliderDesc& desc) {
    double wide = double(value);
    const Edit result = slider(ui, name, wide, desc);
    if (result.changed) value = float(wide);
    return result;
}

Edit slider(Ui& ui, std::string_view name, int& value, SliderDesc desc) {
    desc.decimals = 0;
    desc.step = std::max(1.0, std::round(desc.step));
    double wide = value;
    const Edit result = slider(ui, name, wide, desc);
    if (result.changed) value = int(std::lround(wide));
    return result;
}

}  // namespace loam::ui
