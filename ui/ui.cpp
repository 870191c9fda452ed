#include "ui/ui.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"
#include "ui/ui_private.h"

namespace loam::ui {

constexpr Id kRootId = 14695981039346656037ull;

Ui::Ui(Text& text, const Theme& look) : theme(look), text_(text) {
    lists_.push_back(std::make_unique<DrawList>());
    ids_.push_back(kRootId);
}
Ui::~Ui() = default;

static Id hashed(Id h, std::string_view label) {
    for (const char c : label) h = (h ^ uint8_t(c)) * 1099511628211ull;  // FNV-1a
    h = (h ^ 0xFF) * 1099511628211ull;                                   // "a" inside "b" differs from "ba"
    return h ? h : 1;
}

Id Ui::make_id(std::string_view label) const {
    return hashed(ids_.back(), label);
}

Id Ui::absolute_id(std::string_view label) {
    return hashed(kRootId ^ 0x5BD1E995u, label);
}

void Ui::pop_id() {
    LOAM_CHECK(ids_.size() > 1, "pop_id without push_id");
    ids_.pop_back();
}

void Ui::begin_frame(const FrameInput& input) {
    LOAM_CHECK(!in_frame_, "begin_frame twice without end_frame");
    in_frame_ = true;
    text_.begin_frame();
    time_s_ = input.time_s;
    size_ = {std::max(0.0f, input.size_px.x), std::max(0.0f, input.size_px.y)};
    queue_.insert(queue_.end(), input.events.begin(), input.events.end());
    if (!input.events.empty()) last_input_s_ = time_s_;
    redraw_next_ = false;
    wake_s_ = std::numeric_limits<double>::infinity();
    take_events();

    cursor_ = Cursor::arrow;
    wants_keyboard_ = viewport_hovered_ = false;
    active_seen_ = focus_seen_ = focus_taken_ = false;
    hovered_ = 0;
    tooltip_seen_ = 0;
    focus_order_.clear();
    seen_ids_.clear();
    ids_.resize(1);
    disabled_.assign(1, false);
    reveal_.reset();
    layer_ = 0;
    layer_stack_.clear();
    overlays_at_begin_ = overlays_.size();
    for (Overlay& o : overlays_) o.seen = false;
    lists_.resize(1);  // overlays, tooltip and toast add theirs above, in this order
    lists_[0]->clear(window());
    dock_area_ = window();
    layouts_.clear();
    push_layout(window(), false, 0);
    output_.duplicate_ids = 0;
}

void Ui::take_events() {
    keys_.clear();
    wheel_ = {};
    pressed_.reset();
    released_.reset();
    double_click_ = false;
    mouse_before_ = mouse_;
    bool button = false, key = false;
    while (!queue_.empty()) {
        const Event e = queue_.front();
        const bool mouse_event = e.type == Event::Type::mouse_move || e.type == Event::Type::mouse_button ||
                                 e.type == Event::Type::mouse_leave || e.type == Event::Type::wheel;
        if (button || (key && mouse_event)) break;  // after a button nothing more; after a key no pointer
        // What is typed goes to what has just been opened, once its first field has the focus.
        if (focus_first_ && !overlays_.empty() && (e.type == Event::Type::key || e.type == Event::Type::text))
            break;
        if (e.type == Event::Type::mouse_button && active_ != 0) {
            // A drag is seen to its end before the button changes: no widget has to care about a last
            // movement.
            if (std::isfinite(e.position.x) && std::isfinite(e.position.y)) mouse_ = e.position;
            if (mouse_moved()) break;
        }
        queue_.pop_front();
        bool stop = false;
        switch (e.type) {
            case Event::Type::mouse_move:
                if (std::isfinite(e.position.x) && std::isfinite(e.position.y)) mouse_ = e.position;
                break;
            case Event::Type::mouse_leave:
                if (!active_) mouse_ = {-1e6f, -1e6f};
                break;
            case Event::Type::mouse_button:
                take_button(e), button = true;
                break;
            case Event::Type::wheel:
                if (std::isfinite(e.position.x) && std::isfinite(e.position.y)) wheel_ = wheel_ + e.position;
                mods_ = e.mods;
                break;
            case Event::Type::key:
                if (e.key == Key::none || e.key >= Key::count) break;
                keys_down_[size_t(e.key)] = e.down;
                mods_ = e.mods;
                key = true;
                if (!e.down) break;
                keys_.push_back({e});
                // May move the focus, or be a shortcut that opens something.
                stop = e.key == Key::tab || e.key == Key::enter || e.key == Key::escape || e.mods.ctrl ||
                       (e.key >= Key::f1 && e.key <= Key::f12);
                break;
            case Event::Type::text:
                keys_.push_back({e});
                key = true;
                break;
            case Event::Type::window_blur:
                buttons_ = {};
                keys_down_ = {};
                mods_ = {};
                active_ = 0;
                stop = true;
                break;
        }
        if (stop) break;
    }
}

void Ui::take_button(const Event& e) {
    if (size_t(e.button) >= buttons_.size()) return;
    if (std::isfinite(e.position.x) && std::isfinite(e.position.y)) mouse_ = e.position;
    mods_ = e.mods;
    const bool was_down = std::exchange(buttons_[size_t(e.button)], e.down);
    if (was_down == e.down) return;  // the window system repeated itself
    if (!e.down) {
        released_ = e.button;
        return;
    }
    pressed_ = e.button;
    const Vec2 d = mouse_ - last_press_at_;
    double_click_ = e.button == last_press_button_ && time_s_ - last_press_s_ < theme.double_click_s &&
                    std::hypot(d.x, d.y) < px(4);
    last_press_s_ = double_click_ ? -1e9 : time_s_;  // a third click is not a second double click
    last_press_at_ = mouse_;
    last_press_button_ = e.button;
    tooltip_.used = true;
}

bool Ui::mouse_over(const Rect& rect) const {
    return layer_ >= overlays_at_begin_ && rect.contains(mouse_) && lists_[layer_]->clip().contains(mouse_);
}

Response Ui::interact(Id id, const Rect& rect, Sense sense) {
    Response r{.id = id, .rect = rect};
    seen_ids_.push_back(id);
    if (disabled()) return r;
    const bool over = mouse_over(rect);
    r.hovered = over && (active_ == 0 || active_ == id);
    if (r.hovered) hovered_ = id;
    if (sense == Sense::hover) return r;

    const bool takes_focus = sense != Sense::drag;
    if ((sense == Sense::click || sense == Sense::edit) && on_top()) focus_order_.push_back({id, layer_});
    if (r.hovered && active_ == 0 && pressed_ &&
        (sense == Sense::any_button || *pressed_ == MouseButton::left)) {
        active_ = id;
        active_button_ = *pressed_;
        r.pressed = true;
        r.double_clicked = double_click_;
        if (takes_focus) {
            focus_taken_ = true;
            if (focus_ != id) set_focus(id, false);
        }
    }
    if (active_ == id) {
        active_seen_ = true;
        r.button = active_button_;
        r.held = true;
        if (!r.pressed) r.drag = mouse_ - mouse_before_;
        if (!buttons_[size_t(active_button_)]) {  // the release, or it was lost
            r.released = true;
            r.clicked = over && released_.has_value();
            r.held = false;
            active_ = 0;
        }
    }
    if (focus_ == id) {
        focus_seen_ = true;
        r.focused = true;
        r.focus_visible = focus_visible_;
        if (focus_moved_) {
            focus_moved_ = false;
            if (focus_visible_) reveal_ = rect;
        }
        if (sense == Sense::click && (take_key(Key::space) || take_key(Key::enter))) r.clicked = true;
    }
    return r;
}

void Ui::release_capture() {
    active_ = 0;
}

bool Ui::take_wheel(const Rect& rect, float& notches) {
    if (wheel_.y == 0 || (active_ != 0) || !mouse_over(rect)) return false;
    notches = std::exchange(wheel_.y, 0.0f);
    return true;
}

std::span<Ui::KeyEvent> Ui::keys() {
    return on_top() ? std::span(keys_) : std::span<KeyEvent>();
}

bool Ui::take_key(Key key, Mods mods) {
    for (KeyEvent& k : keys())
        if (!k.used && k.event.type == Event::Type::key && k.event.key == key && k.event.mods == mods) {
            k.used = true;
            return true;
        }
    return false;
}

void Ui::set_focus(Id id, bool visible) {
    if (id != focus_) request_redraw();  // who lost it was perhaps drawn already
    focus_ = id;
    focus_visible_ = visible;
    focus_moved_ = true;
    focus_seen_ = true;
}

void Ui::push_disabled(bool disabled) {
    disabled_.push_back(disabled || disabled_.back());
}

void Ui::pop_disabled() {
    LOAM_CHECK(disabled_.size() > 1, "pop_disabled without push_disabled");
    disabled_.pop_back();
}

void Ui::draw_label(const Rect& area, std::string_view label, TextStyle style, Color color, Align align) {
    if (label.empty() || area.empty()) return;
    const std::string fitted = text_.ellipsis(label, style, area.w);
    const float width = align == Align::left ? 0.0f : text_.measure(fitted, style);
    const float x = align == Align::left    ? area.x
                    : align == Align::right ? area.right() - width
                                            : area.x + (area.w - width) * 0.5f;
    const float cap = text_.metrics(style).cap_height;
    draw().text(text_, {x, std::floor(area.y + (area.h + cap) * 0.5f)}, fitted, style, color);
}

void Ui::draw_focus_ring(const Response& r, float radius) {
    if (!r.focus_visible) return;
    const float width = std::max(1.0f, std::round(1.5f * theme.scale));
    draw().rect(r.rect.grown(width * 0.5f), kTransparent, radius + width * 0.5f, theme.accent, width);
}

const FrameOutput& Ui::end_frame() {
    LOAM_CHECK(in_frame_, "end_frame without begin_frame");
    LOAM_CHECK(layer_stack_.empty() && layouts_.size() == 1, "a scope is still open at end_frame");
    in_frame_ = false;
    settle();
    draw_tooltip();
    draw_toast();

    picture_.clear(window());
    for (const auto& list : lists_) picture_.append(*list);
    const uint64_t hash = picture_.hash();

    output_.draw = &picture_;
    output_.picture_changed = hash != std::exchange(picture_hash_, hash);
    output_.redraw = redraw_next_ || !queue_.empty();
    output_.wake_s = wake_s_;
    output_.captured = active_ != 0;
    output_.wants_keyboard = wants_keyboard_ || !overlays_.empty();
    const bool inside = window().contains(mouse_);
    output_.wants_mouse =
        !overlays_.empty() || (inside && !viewport_hovered_) || (active_ != 0 && !viewport_hovered_);
    output_.cursor = cursor_;
    output_.keys.clear();
    if (!output_.wants_keyboard || wants_keyboard_)
        for (const KeyEvent& k : keys_)
            if (!k.used && k.event.type == Event::Type::key && overlays_.empty())
                output_.keys.push_back(k.event);
    return output_;
}

// What no widget did: drop what vanished, move the focus, count shared ids.
void Ui::settle() {
    if (active_ != 0 && !active_seen_) active_ = 0;
    if (pressed_ && !focus_taken_ && focus_ != 0 && !overlays_at_begin_) set_focus(0, false);
    if (focus_ != 0 && !focus_seen_ && overlays_.empty()) focus_ = 0;

    const size_t before = overlays_.size();
    for (size_t i = 0; i < overlays_.size(); ++i) {
        overlays_[i].unseen = overlays_[i].seen ? 0 : overlays_[i].unseen + 1;
        if (overlays_[i].unseen == 1)
            request_redraw();  // opened after its place in the frame: built in the next
        if (overlays_[i].unseen < 2) continue;
        close_overlay(overlays_[i].id);
        break;
    }
    if (overlays_.size() != before) request_redraw();

    if (focus_first_ && overlays_at_begin_ > 0) {
        focus_first_ = false;
        for (const FocusStop& stop : focus_order_)
            if (stop.layer == overlays_at_begin_) {
                set_focus(stop.id, true);
                break;
            }
    }
    move_focus();

    std::sort(seen_ids_.begin(), seen_ids_.end());
    for (size_t i = 1; i < seen_ids_.size(); ++i) output_.duplicate_ids += seen_ids_[i] == seen_ids_[i - 1];
}

void Ui::move_focus() {
    for (KeyEvent& k : keys_) {
        if (k.used || k.event.type != Event::Type::key || k.event.key != Key::tab) continue;
        if (k.event.mods.ctrl || k.event.mods.alt || k.event.mods.super) continue;
        k.used = true;
        std::vector<Id> order;
        for (const FocusStop& stop : focus_order_)
            if (stop.layer >= overlays_.size()) order.push_back(stop.id);
        if (order.empty()) continue;
        const auto at = std::find(order.begin(), order.end(), focus_);
        const size_t count = order.size();
        size_t next = k.event.mods.shift ? count - 1 : 0;
        if (at != order.end())
            next = (size_t(at - order.begin()) + (k.event.mods.shift ? count - 1 : 1)) % count;
        set_focus(order[next], true);
        request_redraw();
    }
}

}  // namespace loam::ui
