// Input as plain data; no window library. The application appends events in the order in which they happened.
#pragma once

#include <cstdint>

#include "ui/geometry.h"
#include "ui/key.h"

namespace loam::ui {

enum class MouseButton : uint8_t { left, right, middle };
inline constexpr int kMouseButtonCount = 3;

struct Event {
    enum class Type : uint8_t { mouse_move, mouse_leave, mouse_button, wheel, key, text, window_blur };
    Type type = Type::mouse_move;
    Vec2 position{};  // mouse_move, mouse_button: physical pixels; wheel: notches, y > 0 is away
    MouseButton button = MouseButton::left;  // mouse_button
    Key key = Key::none;                     // key
    Mods mods{};                               // mouse_button, wheel, key
    bool down = false;                       // mouse_button, key
    bool repeat = false;                     // key
    char32_t codepoint = 0;                  // text

    static Event move(Vec2 at) { return {.type = Type::mouse_move, .position = at}; }
    static Event leave() { return {.type = Type::mouse_leave}; }
    static Event press(Vec2 at, MouseButton b = MouseButton::left, Mods m = {}) {
        return {.type = Type::mouse_button, .position = at, .button = b, .mods = m, .down = true};
    }
    static Event release(Vec2 at, MouseButton b = MouseButton::left, Mods m = {}) {
        return {.type = Type::mouse_button, .position = at, .button = b, .mods = m, .down = false};
    }
    static Event scroll(Vec2 notches, Mods m = {}) {
        return {.type = Type::wheel, .position = notches, .mods = m};
    }
    static Event key_down(Key k, Mods m = {}, bool repeated = false) {
        return {.type = Type::key, .key = k, .mods = m, .down = true, .repeat = repeated};
    }
    static Event key_up(Key k, Mods m = {}) { return {.type = Type::key, .key = k, .mods = m}; }
    static Event character(char32_t c) { return {.type = Type::text, .codepoint = c}; }
    static Event blur() { return {.type = Type::window_blur}; }
};

enum class Cursor : uint8_t { arrow, hand, text, resize_x, resize_y, crosshair };

}  // namespace loam::ui
