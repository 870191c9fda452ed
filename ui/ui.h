// The context of an immediate-mode interface: input, ids, focus, layers, layout, drawing. Widgets are free
// functions over it (widgets.h), written with the same calls that an application has for its own.
//
//     ui.begin_frame({.events = events, .time_s = now, .size_px = size});
//     ... panels and widgets ...
//     const FrameOutput& out = ui.end_frame();
//
// Longer than 200 lines because it is the one contract of all widgets.
#pragma once

#include <array>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ui/draw_list.h"
#include "ui/input.h"
#include "ui/layout.h"
#include "ui/text.h"
#include "ui/theme.h"

namespace loam::ui {

using Id = uint64_t;  // 0: nothing
class Ui;

// Closes what a begin opened when it leaves scope; false when there is nothing to put inside.
class [[nodiscard]] Scope {
  public:
    using End = void (*)(Ui&);
    Scope() = default;
    Scope(Ui& ui, End end) : ui_(&ui), end_(end) {}
    Scope(Scope&& o) noexcept : ui_(std::exchange(o.ui_, nullptr)), end_(o.end_) {}
    Scope& operator=(Scope&&) = delete;
    ~Scope() {
        if (ui_) end_(*ui_);
    }
    explicit operator bool() const { return ui_ != nullptr; }

  private:
    Ui* ui_ = nullptr;
    End end_ = nullptr;
};

struct FrameInput {
    std::span<const Event> events{};
    double time_s = 0;
    Vec2 size_px{};
};

struct FrameOutput {
    const DrawList* draw = nullptr;
    bool redraw = false;  // build another frame now, without waiting for input
    double wake_s = std::numeric_limits<double>::infinity();  // … or at this time (caret, tooltip, toast)
    bool picture_changed = true;  // false: the same picture as the frame before, no need to draw it
    bool wants_mouse = false;     // over or captured by the interface, the viewport not counted
    bool wants_keyboard = false;  // a text field, a menu or a dialog has the keys
    Cursor cursor = Cursor::arrow;
    std::vector<Event> keys;  // key presses that nothing used: for shortcuts
    int duplicate_ids = 0;    // widgets that shared an id: a bug of the caller
    bool captured = false;    // a widget holds the mouse
};

enum class Sense : uint8_t {
    click,       // left button; takes the keyboard focus, is reached by Tab, activated by Space and Enter
    edit,        // the same, but keeps Space and Enter for itself: text
    drag,        // left button, no focus: splitters, scroll bars
    any_button,  // any button, focus by press: viewports
    hover,       // nothing but the pointer's place
};

struct Response {
    Id id = 0;
    Rect rect{};
    bool hovered = false;  // the pointer is over it and belongs to it
    bool pressed = false;  // went down on it in this frame
    bool held = false;     // captured
    bool released = false;
    bool clicked = false;  // released over it, or Space/Enter with the focus
    bool double_clicked = false;
    bool focused = false;
    bool focus_visible = false;              // focus came by keyboard: draw the ring
    MouseButton button = MouseButton::left;  // of pressed, held, released
    Vec2 drag{};                               // since the last frame while held
};

struct Clipboard {
    std::string (*get)(void* user) = nullptr;
    void (*set)(void* user, std::string_view text) = nullptr;
    void* user = nullptr;
};

class Ui {
  public:
    explicit Ui(Text& text, const Theme& theme = {});
    ~Ui();
    Ui(const Ui&) = delete;

    // Events are taken in order; at most one button change (or Tab, Enter, Escape) a frame, the rest waits
    // and asks for another frame. So a press and release within one slow frame are never lost, and order is
    // kept.
    void begin_frame(const FrameInput& input);
    const FrameOutput& end_frame();

    Theme theme;
    Clipboard clipboard;
    [[nodiscard]] float px(float logical) const { return theme.px(logical); }
    [[nodiscard]] Text& text() { return text_; }
    [[nodiscard]] double time_s() const { return time_s_; }
    [[nodiscard]] Rect window() const { return {0, 0, size_.x, size_.y}; }
    void request_redraw() { redraw_next_ = true; }
    void wake_at(double time_s) { wake_s_ = std::min(wake_s_, time_s); }

    // Ids: a label hashed with the ids around it. "Name##7" shows "Name"; two widgets in one scope need two
    // labels.
    [[nodiscard]] Id make_id(std::string_view label) const;
    [[nodiscard]] static Id absolute_id(std::string_view label);  // the same wherever it is asked: dialogs
    void push_id(std::string_view label) { ids_.push_back(make_id(label)); }
    void push_id(Id id) { ids_.push_back(id); }
    void pop_id();
    // What a widget remembers. Lives as long as the Ui; a type per id.
    template <typename T>
    T& state(Id id);

    // Interaction.
    Response interact(Id id, const Rect& rect, Sense sense);
    [[nodiscard]] Vec2 mouse() const { return mouse_; }
    [[nodiscard]] bool mouse_over(const Rect& rect) const;  // inside clip, not below an overlay
    [[nodiscard]] Vec2 wheel() const { return wheel_; }
    [[nodiscard]] bool button_down(MouseButton b) const { return buttons_[size_t(b)]; }
    [[nodiscard]] std::optional<MouseButton> pressed_button() const { return pressed_; }
    [[nodiscard]] std::optional<MouseButton> released_button() const { return released_; }
    [[nodiscard]] bool mouse_moved() const { return !(mouse_ == mouse_before_); }
    [[nodiscard]] double last_input_s() const { return last_input_s_; }
    [[nodiscard]] Mods mods() const { return mods_; }
    [[nodiscard]] bool key_is_down(Key key) const { return keys_down_[size_t(key)]; }
    bool take_wheel(const Rect& rect, float& notches);  // true once, for the innermost that asks first
    bool take_key(Key key, Mods mods = {});             // presses and repeats; only on the top layer
    // All keys and characters not yet used, to go through and mark as used (text fields).
    struct KeyEvent {
        Event event;
        bool used = false;
    };
    [[nodiscard]] std::span<KeyEvent> keys();
    void want_keyboard() { wants_keyboard_ = true; }
    void set_cursor(Cursor cursor) { cursor_ = cursor; }
    void set_viewport_hovered() { viewport_hovered_ = true; }
    [[nodiscard]] Id active() const { return active_; }
    void release_capture();
    [[nodiscard]] Id focus() const { return focus_; }
    void set_focus(Id id, bool visible);
    void push_disabled(bool disabled);
    void pop_disabled();
    [[nodiscard]] bool disabled() const { return disabled_.back(); }
    void tooltip(const Response& r, std::string_view text, std::string_view shortcut = {});
    void toast(std::string_view message, Color mark, double seconds = 4);

    // Layout.
    [[nodiscard]] Scope row(std::initializer_list<Size> sizes,
                            float height = 0);   // logical; 0: control height
    [[nodiscard]] Scope flow(float height = 0);  // a row of widgets as wide as they like
    [[nodiscard]] Scope column(float gap = -1);  // in the next cell, or all that is left
    [[nodiscard]] Scope column_in(const Rect& area, float gap = -1);
    [[nodiscard]] Scope row_in(const Rect& area, float gap = -1);
    // The same without a scope, for widgets that open more than a layout.
    void begin_column(const Rect& area, float gap = -1) { push_layout(area, false, gap); }
    void begin_row(const Rect& area, float gap = -1) { push_layout(area, true, gap); }
    void end_layout() { pop_layout(); }
    Rect allocate(Vec2 wanted_px);  // the next widget's place
    Rect allocate_rest();           // all that is left
    void space(float logical);
    void spring();  // in a flow: what follows is pushed to the end
    [[nodiscard]] Rect remaining() const;
    [[nodiscard]] bool in_column() const;
    [[nodiscard]] float content_end() const;  // bottom (column) or right end (row) of what was placed

    // Docking: cuts panels off the window, in the order of the calls; what is left is for the viewport.
    Rect dock(Edge edge, float size_px) { return cut(dock_area_, edge, size_px); }
    [[nodiscard]] Rect dock_rest() const { return dock_area_; }

    // Drawing: into the current layer.
    [[nodiscard]] DrawList& draw() { return *lists_[layer_]; }
    [[nodiscard]] TextStyle style(Weight weight = Weight::regular) const {
        return {weight, theme.font_size * theme.scale};
    }
    [[nodiscard]] TextStyle small_style() const {
        return {Weight::regular, theme.font_size_small * theme.scale};
    }
    [[nodiscard]] TextStyle code_style() const { return {Weight::mono, (theme.font_size - 1) * theme.scale}; }
    enum class Align { left, center, right };
    // One line, vertically centred by cap height, shortened with an ellipsis.
    void draw_label(const Rect& area, std::string_view text, TextStyle style, Color color,
                    Align align = Align::left);
    void draw_focus_ring(const Response& r, float radius);

    // Overlays: popups and dialogs. One that is open takes mouse and keys from everything below it.
    void open_overlay(Id id);
    [[nodiscard]] bool overlay_open(Id id) const;
    void close_overlay(Id id);  // and those above it
    [[nodiscard]] bool overlay_just_opened(Id id) const;
    void begin_overlay(Id id);  // switches to its layer; only when open
    void end_overlay();
    [[nodiscard]] bool on_top() const { return layer_ >= overlays_at_begin_; }
    // Lets the widgets until `end_raised` work as if on the top layer (menu titles while a menu is open).
    void begin_raised();
    void end_raised();
    void reveal(const Rect& rect) { reveal_ = rect; }
    std::optional<Rect>& revealed() { return reveal_; }

  private:
    struct Layout;
    struct Overlay {
        Id id = 0, focus_before = 0;
        bool seen = false, fresh = true;
        int unseen = 0;  // frames nobody built it: its owner is gone
    };
    struct StateBase {
        virtual ~StateBase() = default;
    };
    template <typename T>
    struct StateOf : StateBase {
        T value{};
    };
    template <typename T>
    static const void* type_tag() {
        static const char tag = 0;
        return &tag;
    }
    struct Tooltip {
        Id id = 0;
        double since_s = 0;
        bool used = false;  // dismissed by a press
        std::string text, shortcut;
        Rect anchor;
    };
    struct Toast {
        std::string text;
        Color mark;
        double until_s = 0;
    };
    void take_events();
    void take_button(const Event& event);
    void push_layout(const Rect& area, bool is_row, float gap);
    void pop_layout();
    void move_focus();
    void draw_tooltip();
    void draw_toast();
    void settle();

    Text& text_;
    std::deque<Event> queue_;
    std::vector<KeyEvent> keys_;
    std::vector<KeyEvent> no_keys_;
    double time_s_ = 0, wake_s_ = 0, last_input_s_ = 0;
    Vec2 size_, mouse_{-1e6f, -1e6f}, mouse_before_{-1e6f, -1e6f}, wheel_;
    std::array<bool, kMouseButtonCount> buttons_{};
    std::optional<MouseButton> pressed_, released_;
    bool double_click_ = false;
    double last_press_s_ = -1e9;
    Vec2 last_press_at_{};
    MouseButton last_press_button_ = MouseButton::left;
    Mods mods_{};
    std::array<bool, size_t(Key::count)> keys_down_{};

    Id active_ = 0, focus_ = 0, hovered_ = 0;
    MouseButton active_button_ = MouseButton::left;
    bool active_seen_ = false, focus_seen_ = false, focus_visible_ = false, focus_moved_ = false,
         focus_taken_ = false;
    bool focus_first_ = false;  // the next frame gives the focus to the first widget of the top layer
    struct FocusStop {
        Id id;
        size_t layer;
    };
    std::vector<FocusStop> focus_order_;
    std::vector<Id> ids_, seen_ids_;
    std::vector<bool> disabled_{false};
    std::unordered_map<Id, std::unique_ptr<StateBase>> states_;

    std::vector<std::unique_ptr<DrawList>> lists_;
    DrawList picture_;
    size_t layer_ = 0, overlays_at_begin_ = 0;
    std::vector<size_t> layer_stack_;
    std::vector<Overlay> overlays_;
    std::vector<Layout> layouts_;
    Rect dock_area_{};
    Tooltip tooltip_;
    Id tooltip_seen_ = 0;
    std::optional<Toast> toast_;
    std::optional<Rect> reveal_;

    bool in_frame_ = false, redraw_next_ = false, wants_keyboard_ = false, viewport_hovered_ = false;
    Cursor cursor_ = Cursor::arrow;
    uint64_t picture_hash_ = 0;
    FrameOutput output_;
};

template <typename T>
T& Ui::state(Id id) {
    // The type is part of the key, so that two kinds of state under one id cannot be confused.
    std::unique_ptr<StateBase>& slot = states_[id ^ reinterpret_cast<uintptr_t>(type_tag<T>())];
    if (!slot) slot = std::make_unique<StateOf<T>>();
    return static_cast<StateOf<T>&>(*slot).value;
}

// "Name##7" → "Name".
[[nodiscard]] inline std::string_view visible_label(std::string_view label) {
    return label.substr(0, label.find("##"));
}

}  // namespace loam::ui
