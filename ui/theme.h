// The look, in one place. Sizes are logical pixels on a grid of 4; `px` turns them into whole physical
// pixels. Contrast, checked by ui_theme_test: text on its background at least 4.5 : 1, dim text at least 3 :
// 1 (WCAG 2 AA).
#pragma once

#include <cmath>

#include "ui/geometry.h"

namespace loam::ui {

struct Theme {
    float scale = 1.0f;  // physical pixels a logical pixel

    Color window = Color::hex(0x17191c);      // behind everything; gaps between panels
    Color panel = Color::hex(0x1f2226);       // docked panels
    Color panel_edge = Color::hex(0x111316);  // hairline between panels
    Color header = Color::hex(0x272b30);      // section headers
    Color popup = Color::hex(0x262a2f);       // menus, combo lists, dialogs, tooltips
    Color popup_edge = Color::hex(0x3b4047);
    Color field = Color::hex(0x15171a);  // text fields, slider troughs
    Color field_hover = Color::hex(0x1a1d20);
    Color field_edge = Color::hex(0x363b42);
    Color field_edge_hover = Color::hex(0x4b525b);
    Color fill = Color::hex(0x33414f);  // filled part of a slider
    Color fill_hover = Color::hex(0x3b4c5e);
    Color button = Color::hex(0x32373e);
    Color button_hover = Color::hex(0x3c424a);
    Color button_held = Color::hex(0x2a2e34);
    Color hover = Color::hex(0xffffff, 16);  // laid over flat things: tool buttons, menu titles
    Color text = Color::hex(0xdde1e6);
    Color text_dim = Color::hex(0x9aa2ac);  // captions, units, shortcuts
    Color text_disabled = Color::hex(0x646b74);
    Color accent = Color::hex(0x4c8dd6);  // selection, focus, primary buttons
    Color accent_hover = Color::hex(0x5f9ce0);
    Color accent_soft = Color::hex(0x2b435e);  // selected rows, tool in use, selected text
    Color accent_text = Color::hex(0xffffff);
    Color error = Color::hex(0xe5686b);
    Color warning = Color::hex(0xe0b050);
    Color success = Color::hex(0x6cbf84);
    Color shadow = Color::hex(0x000000, 110);
    Color veil = Color::hex(0x0b0c0e, 150);  // over the window while a dialog is open
    Color scroll_bar = Color::hex(0x474d55);
    Color scroll_bar_hover = Color::hex(0x5d646e);

    float font_size = 13, font_size_small = 11;
    float control_height = 24;  // fields, buttons, sliders, combos
    float row_gap = 4;          // between rows of a panel
    float gap = 8;              // between widgets of a row
    float padding = 12;         // inside panels
    float radius = 4;
    float popup_radius = 6;
    float icon_size = 20;  // in tool bars; 16 elsewhere
    float tool_button = 32;
    float menu_item_height = 26;
    float section_height = 28;
    float scroll_bar_width = 10;
    float label_share = 0.40f;  // of a property row
    float splitter = 5;         // width that takes the mouse; 1 px of it is seen

    float tooltip_delay_s = 0.5f;
    float caret_blink_s = 0.53f;
    float caret_rest_s = 10.0f;  // stops blinking after so long without input, so that the window can rest
    float double_click_s = 0.4f;

    // Whole pixels, so that edges stay sharp; something that is there never vanishes.
    [[nodiscard]] float px(float logical) const {
        const float p = std::round(logical * scale);
        return logical > 0 ? std::max(1.0f, p) : p;
    }
};

// WCAG 2 contrast ratio, 1 … 21.
[[nodiscard]] inline float contrast_ratio(Color a, Color b) {
    const auto linear = [](uint8_t v) {
        const float c = float(v) / 255.0f;
        return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
    };
    const auto luminance = [&](Color c) {
        return 0.2126f * linear(c.r) + 0.7152f * linear(c.g) + 0.0722f * linear(c.b);
    };
    const float la = luminance(a) + 0.05f, lb = luminance(b) + 0.05f;
    return la > lb ? la / lb : lb / la;
}

}  // namespace loam::ui
