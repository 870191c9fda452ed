#include "ui/key.h"

#include <array>

#include <fmt/format.h>

namespace loam::ui {

std::string key_name(Key key) {
    const int k = int(key);
    if (key >= Key::a && key <= Key::z) return std::string(1, char('A' + k - int(Key::a)));
    if (key >= Key::digit_0 && key <= Key::digit_9) return std::string(1, char('0' + k - int(Key::digit_0)));
    if (key >= Key::f1 && key <= Key::f12) return fmt::format("F{}", k - int(Key::f1) + 1);
    static constexpr std::array kNames = {
        "Left", "Right",     "Up",  "Down",  "Home", "End",   "Page Up", "Page Down", "Insert",
        "Del",  "Backspace", "Tab", "Enter", "Esc",  "Space", "-",       "=",         ",",
        ".",    "/",         ";",   "'",     "[",    "]",     "\\",      "`"};
    static_assert(kNames.size() == size_t(Key::count) - size_t(Key::left));
    if (key >= Key::left && key < Key::count) return kNames[size_t(k) - size_t(Key::left)];
    return {};
}

std::string key_label(Key key, Mods mods) {
    std::string label;
    if (mods.ctrl) label += "Ctrl+";
    if (mods.alt) label += "Alt+";
    if (mods.shift) label += "Shift+";
    if (mods.super) label += "Super+";
    return label + key_name(key);
}

}  // namespace loam::ui
