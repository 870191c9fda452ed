// An interface with every widget, for tests and pictures. Nothing of terrain: values only.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "ui/widgets.h"

namespace loam::ui {

struct Demo {
    double radius = 12.5, strength = 0.35, hardness = 0.6, sun = 42;
    int count = 3, falloff = 1, tool = 0, layer = 2;
    bool spray = true, grid = false;
    std::string name = "North ridge", filter;
    float side = 320;
    int saved = 0, dialog_answer = -1;
    TextureId picture = 0;
    ViewportResponse view;
    Shortcuts shortcuts;

    Demo() {
        shortcuts.bind("save", Key::s, {.ctrl = true});
        shortcuts.bind("undo", Key::z, {.ctrl = true});
        shortcuts.bind("redo", Key::z, {.ctrl = true, .shift = true});
        shortcuts.bind("raise", Key::digit_1);
    }

    void menus(Ui& ui) {
        auto top = panel(ui, "top", {.edge = Edge::top, .size = 36, .horizontal = true, .padding = 8});
        auto bar = menu_bar(ui);
        if (auto file = menu(ui, "File")) {
            menu_item(ui, {.label = "Open project…", .shortcut = "Ctrl+O", .icon = Icon::open});
            if (menu_item(ui, {.label = "Save", .shortcut = shortcuts.label("save"), .icon = Icon::save}))
                ++saved;
            menu_item(ui, {.label = "Revert", .enabled = false});
            menu_separator(ui);
            if (menu_item(ui, {.label = "Delete layer…", .icon = Icon::trash}))
                open_dialog(ui, "Delete layer?");
        }
        if (auto edit = menu(ui, "Edit")) {
            menu_item(ui, {.label = "Undo", .shortcut = shortcuts.label("undo"), .icon = Icon::undo});
            menu_item(
                ui,
                {.label = "Redo", .shortcut = shortcuts.label("redo"), .icon = Icon::redo, .enabled = false});
        }
        if (auto view_menu = menu(ui, "View"))
            if (menu_item(ui, {.label = "Grid", .checked = grid})) grid = !grid;
        ui.spring();
        label(ui, "North ridge", Tone::dim);
    }

    void tools(Ui& ui) {
        auto bar = panel(ui, "tools", {.edge = Edge::left, .size = 45, .padding = 6});
        static constexpr std::array kTools = {
            std::pair("Raise", Icon::raise),   std::pair("Lower", Icon::lower),
            std::pair("Smooth", Icon::smooth), std::pair("Flatten", Icon::flatten),
            std::pair("Noise", Icon::noise),   std::pair("Paint", Icon::paint),
            std::pair("Crater", Icon::crater), std::pair("Footprints", Icon::footprints)};
        for (int i = 0; i < int(kTools.size()); ++i) {
            const auto [words, icon] = kTools[size_t(i)];
            const std::string keys = i == 0 ? shortcuts.label("raise") : std::string();
            if (icon_button(ui, words,
                            {.icon = icon, .toggled = tool == i, .tooltip = words, .shortcut = keys}))
                tool = i;
        }
        separator(ui);
        for (const auto& [words, icon] :
             {std::pair("Camera", Icon::camera), std::pair("Layers", Icon::layers),
              std::pair("Visible", Icon::eye), std::pair("Search", Icon::search),
              std::pair("Settings", Icon::settings), std::pair("Play", Icon::play)})
            icon_button(ui, words, {.icon = icon, .tooltip = words});
    }

    void sides(Ui& ui) {
        auto side_panel = panel(
            ui, "side",
            {.edge = Edge::right, .min_size = 240, .resizable = true, .scroll = true, .stored_size = &side});
        if (auto s = section(ui, "Brush")) {
            slider(ui, "Radius", radius,
                   {.min = 0.5, .max = 200, .decimals = 1, .unit = "m", .logarithmic = true});
            slider(ui, "Strength", strength, {.tooltip = "Height a second"});
            slider(ui, "Hardness", hardness, {});
            slider(ui, "Count", count, {.min = 1, .max = 12});
            static constexpr std::string_view kFalloff[] = {"Linear", "Smooth", "Sphere", "Constant"};
            combo(ui, "Falloff", falloff, kFalloff);
            if (auto p = property(ui, "Options")) {
                checkbox(ui, "Spray", spray);
                checkbox(ui, "Grid", grid);
            }
        }
        if (auto s = section(ui, "Layers")) {
            text_field(ui, "##filter", filter, {.placeholder = "Filter layers", .icon = Icon::search});
            ui.space(4);
            const Tile tiles[] = {{.caption = "Grass", .color = Color::hex(0x5d7a3c)},
                                  {.caption = "Dry grass", .color = Color::hex(0x9c8c4e)},
                                  {.caption = "Rock", .texture = picture, .color = Color::hex(0x77736c)},
                                  {.caption = "Snow", .color = Color::hex(0xdfe6ea)},
                                  {.caption = "Mud with gravel", .color = Color::hex(0x5b4636)}};
            tile_grid(ui, "palette", tiles, layer);
        }
        if (auto s = section(ui, "Object")) {
            text_field(ui, "Name", name);
            slider(ui, "Sun height", sun, {.min = -10, .max = 90, .step = 0.5, .decimals = 1, .unit = "°"});
            ui.push_disabled(true);
            slider(ui, "Locked", hardness, {});
            button(ui, "Not now##disabled");
            ui.pop_disabled();
            ui.space(4);
            auto row = ui.row({flex(), flex()});
            button(ui, "Reset", {.icon = Icon::undo});
            if (button(ui, "Apply", {.primary = true})) ui.toast("Applied to 12 pages", ui.theme.success);
        }
        if (auto s = section(ui, "About", Section::closed)) paragraph(ui, "Closed at first.");
        progress(ui, 0.62, "62 %");
        paragraph(ui, "Pages that are far away are composed later; what is near comes first.", Tone::dim);
    }

    void status(Ui& ui) {
        auto line = panel(ui, "status", {.edge = Edge::bottom, .size = 26, .horizontal = true});
        label(ui, "1024.5, 382.0, 41.27 m", Tone::dim);
        separator(ui);
        label(ui, "Undo: Raise", Tone::dim);
        ui.spring();
        label(ui, "16.4 ms", Tone::dim);
    }

    void build(Ui& ui) {
        menus(ui);
        status(ui);
        tools(ui);
        sides(ui);
        view = viewport(ui, "scene");
        if (auto d = dialog(ui, "Delete layer?")) {
            paragraph(
                ui,
                "“Mud with gravel” is still painted on 12 pages. They will show the layer below it instead.");
            text_field(ui, "Type its name", filter);
            dialog_answer = dialog_buttons(ui, {"Cancel", "Delete"});
        }
    }
};

// A Ui with a clock that runs only when told, driven one event or several at a time.
struct Harness {
    std::unique_ptr<Text> text;
    std::unique_ptr<Ui> ui;
    double time_s = 1;
    Vec2 size{1280, 800};
    FrameOutput last;

    explicit Harness(float scale = 1) {
        auto made = Text::create();
        if (!made) throw std::runtime_error(made.message());
        text = std::move(made).value();
        Theme theme;
        theme.scale = scale;
        ui = std::make_unique<Ui>(*text, theme);
    }
    template <typename Build>
    const FrameOutput& frame(std::initializer_list<Event> events, Build&& build) {
        std::vector<Event> pending(events);
        return frame(std::span<const Event>(pending), build);
    }
    // Builds until nothing is left to do, at most 50 times; keys are collected over all of them.
    template <typename Build>
    const FrameOutput& frame(std::span<const Event> events, Build&& build) {
        std::vector<Event> keys;
        bool changed = false;
        for (int i = 0; i < 50; ++i) {
            ui->begin_frame(
                {.events = i == 0 ? events : std::span<const Event>(), .time_s = time_s, .size_px = size});
            build(*ui);
            last = ui->end_frame();
            keys.insert(keys.end(), last.keys.begin(), last.keys.end());
            changed |= last.picture_changed;
            if (!last.redraw) break;
        }
        last.keys = keys;
        last.picture_changed = changed;
        return last;
    }
    template <typename Build>
    void click(Vec2 at, Build&& build) {
        frame({Event::move(at), Event::press(at), Event::release(at)}, build);
        time_s += 1;
    }
};

}  // namespace loam::ui
