// Overlays, tooltips and toasts of the context.
#include <cmath>

#include "runtime/base/check.h"
#include "ui/ui.h"
#include "ui/ui_private.h"

namespace loam::ui {

void Ui::open_overlay(Id id) {
    if (overlay_open(id)) return;
    // Opened from below an open one: it replaces what is above the opener's layer.
    while (overlays_.size() > layer_) close_overlay(overlays_.back().id);
    overlays_.push_back({.id = id, .focus_before = focus_});
    focus_first_ = true;
    tooltip_.used = true;
    request_redraw();
}

bool Ui::overlay_open(Id id) const {
    for (const Overlay& o : overlays_)
        if (o.id == id) return true;
    return false;
}

bool Ui::overlay_just_opened(Id id) const {
    for (const Overlay& o : overlays_)
        if (o.id == id) return o.fresh;
    return false;
}

void Ui::close_overlay(Id id) {
    for (size_t i = 0; i < overlays_.size(); ++i) {
        if (overlays_[i].id != id) continue;
        focus_ = overlays_[i].focus_before;
        focus_seen_ = true;
        overlays_.resize(i);
        active_ = 0;
        focus_first_ = false;
        request_redraw();
        return;
    }
}

void Ui::begin_overlay(Id id) {
    layer_stack_.push_back(layer_);
    for (size_t i = 0; i < overlays_.size(); ++i)
        if (overlays_[i].id == id) {
            layer_ = i + 1;
            overlays_[i].seen = true;
            if (i < overlays_at_begin_) overlays_[i].fresh = false;
        }
    while (lists_.size() <= layer_) {
        lists_.push_back(std::make_unique<DrawList>());
        lists_.back()->clear(window());
    }
}

void Ui::end_overlay() {
    LOAM_CHECK(!layer_stack_.empty(), "end_overlay without begin_overlay");
    layer_ = layer_stack_.back();
    layer_stack_.pop_back();
}

void Ui::begin_raised() {
    layer_stack_.push_back(layer_);
    layer_ = std::max(layer_, overlays_at_begin_);
    while (lists_.size() <= layer_) {
        lists_.push_back(std::make_unique<DrawList>());
        lists_.back()->clear(window());
    }
}

void Ui::end_raised() {
    end_overlay();
}

void Ui::tooltip(const Response& r, std::string_view words, std::string_view shortcut) {
    if (!r.hovered || words.empty()) return;
    tooltip_seen_ = r.id;
    if (tooltip_.id != r.id) {
        tooltip_ = {};
        tooltip_.id = r.id;
        tooltip_.since_s = time_s_;
    }
    tooltip_.text = words;
    tooltip_.shortcut = shortcut;
    tooltip_.anchor = r.rect;
}

void Ui::draw_tooltip() {
    if (tooltip_seen_ == 0) {
        tooltip_ = {};
        return;
    }
    if (tooltip_.used || active_ != 0) return;
    const double due = tooltip_.since_s + double(theme.tooltip_delay_s);
    if (time_s_ < due) {
        wake_at(due);
        return;
    }
    const TextStyle words = style();
    const float gap = tooltip_.shortcut.empty() ? 0 : px(12);
    const float width =
        std::ceil(text_.measure(tooltip_.text, words) + gap + text_.measure(tooltip_.shortcut, words)) +
        px(20);
    Rect r{tooltip_.anchor.x, tooltip_.anchor.bottom() + px(6), width, px(28)};
    // A tall narrow bar on the left shows its hints to the right; everything stays inside the window.
    if (tooltip_.anchor.x < px(48))
        r.x = tooltip_.anchor.right() + px(6), r.y = std::round(tooltip_.anchor.center().y - r.h * 0.5f);
    if (r.bottom() > size_.y) r.y = tooltip_.anchor.y - r.h - px(6);
    r.x = std::max(px(4), std::min(r.x, size_.x - r.w - px(4)));

    layer_ = lists_.size();
    lists_.push_back(std::make_unique<DrawList>());
    lists_.back()->clear(window());
    draw().shadow({r.x, r.y + px(2), r.w, r.h}, theme.shadow, px(theme.radius), px(8));
    draw().rect(r, theme.popup, px(theme.radius), theme.popup_edge, px(1));
    const Rect inner = r.inset(px(10), 0);
    draw_label(inner, tooltip_.text, words, theme.text);
    draw_label(inner, tooltip_.shortcut, words, theme.text_dim, Align::right);
    layer_ = 0;
}

void Ui::toast(std::string_view message, Color mark, double seconds) {
    toast_ = Toast{std::string(message), mark, time_s_ + seconds};
    request_redraw();
}

void Ui::draw_toast() {
    if (!toast_) return;
    if (time_s_ >= toast_->until_s) {
        toast_.reset();
        return;
    }
    wake_at(toast_->until_s);
    const float width = std::min(size_.x - px(32), std::ceil(text_.measure(toast_->text, style())) + px(44));
    const Rect r{std::round(dock_area_.center().x - width * 0.5f), dock_area_.bottom() - px(52), width,
                 px(36)};
    layer_ = lists_.size();
    lists_.push_back(std::make_unique<DrawList>());
    lists_.back()->clear(window());
    draw().shadow({r.x, r.y + px(3), r.w, r.h}, theme.shadow, px(theme.popup_radius), px(12));
    draw().rect(r, theme.popup, px(theme.popup_radius), theme.popup_edge, px(1));
    draw().circle({r.x + px(17), r.center().y}, px(4), toast_->mark);
    draw_label({r.x + px(30), r.y, r.w - px(44), r.h}, toast_->text, style(), theme.text);
    layer_ = 0;
}

}  // namespace loam::ui
