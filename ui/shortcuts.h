// Key and modifiers → action. Menus and tooltips show the label; the application asks `find` with the keys
// that the interface did not use (FrameOutput::keys).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ui/key.h"

namespace loam::ui {

struct Shortcut {
    std::string action{};
    Key key = Key::none;
    Mods mods{};
};

class Shortcuts {
  public:
    // Takes the key from whichever action had it; an action may have several, its first is the one displayed.
    void bind(std::string_view action, Key key, Mods mods = {});
    void unbind(std::string_view action);
    [[nodiscard]] std::optional<std::string_view> find(Key key, Mods mods) const;
    [[nodiscard]] std::string label(std::string_view action) const;  // empty when there is none
    [[nodiscard]] const std::vector<Shortcut>& all() const { return bound_; }

  private:
    std::vector<Shortcut> bound_;
};

}  // namespace loam::ui
