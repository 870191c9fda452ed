// Keys by their meaning on the layout in use (letters, digits) or their function. The window layer
// translates.
#pragma once

#include <cstdint>
#include <string>

namespace loam::ui {

// clang-format off
enum class Key : uint8_t {
    none,
    a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
    digit_0, digit_1, digit_2, digit_3, digit_4, digit_5, digit_6, digit_7, digit_8, digit_9,
    f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
    left, right, up, down, home, end, page_up, page_down, insert, del, backspace,
    tab, enter, escape, space,
    minus, equal, comma, period, slash, semicolon, apostrophe, left_bracket, right_bracket, backslash, grave,
    count
};
// clang-format on

struct Mods {
    bool ctrl = false, shift = false, alt = false, super = false;
    [[nodiscard]] bool none() const { return !ctrl && !shift && !alt && !super; }
    bool operator==(const Mods&) const = default;
};

[[nodiscard]] std::string key_name(Key key);              // "S", "F5", "Page Up"
[[nodiscard]] std::string key_label(Key key, Mods mods);  // "Ctrl+Shift+S"

}  // namespace loam::ui
