#include "ui/shortcuts.h"

namespace loam::ui {

void Shortcuts::bind(std::string_view action, Key key, Mods mods) {
    std::erase_if(bound_, [&](const Shortcut& s) { return s.key == key && s.mods == mods; });
    bound_.push_back({std::string(action), key, mods});
}

void Shortcuts::unbind(std::string_view action) {
    std::erase_if(bound_, [&](const Shortcut& s) { return s.action == action; });
}

std::optional<std::string_view> Shortcuts::find(Key key, Mods mods) const {
    for (const Shortcut& s : bound_)
        if (s.key == key && s.mods == mods) return s.action;
    return std::nullopt;
}

std::string Shortcuts::label(std::string_view action) const {
    for (const Shortcut& s : bound_)
        if (s.action == action) return key_label(s.key, s.mods);
    return {};
}

}  // namespace loam::ui
