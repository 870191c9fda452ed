#include "editor/choices.h"
#include "editor/window/panels.h"

namespace loam::window {

namespace {

void action_item(App& app, ui::Ui& ui, std::string_view label, std::string_view action, ui::Icon icon = ui::Icon::none,
                 bool enabled = true, bool checked = false) {
    const std::string shortcut = app.shortcuts.label(action);
    if (ui::menu_item(ui, {.label = label, .shortcut = shortcut, .icon = icon, .enabled = enabled, .checked = checked}))
        app.run(action, ui);
}

void file_menu(App& app, ui::Ui& ui) {
    action_item(app, ui, "Open…", "open", ui::Icon::open);
    action_item(app, ui, "Save", "save", ui::Icon::save);
    ui::menu_separator(ui);
    action_item(app, ui, "Add layer…", "add layer", ui::Icon::paint);
    action_item(app, ui, "Add stamp…", "add stamp", ui::Icon::stamp);
    action_item(app, ui, "Add imagery…", "add imagery", ui::Icon::open);
    action_item(app, ui, "Record script…", "record", ui::Icon::play);
    action_item(app, ui, "Export picture…", "export", ui::Icon::camera);
    ui::menu_separator(ui);
    action_item(app, ui, "Quit", "quit");
}

void edit_menu(App& app, ui::Ui& ui) {
    action_item(app, ui, "Undo", "undo", ui::Icon::undo, app.session.document().can_undo());
    action_item(app, ui, "Redo", "redo", ui::Icon::redo, app.session.document().can_redo());
    ui::menu_separator(ui);
    action_item(app, ui, "Fill the map", "fill", ui::Icon::paint);
}

// Of the picture while something moves; at rest it is always whole.
void resolution_items(App& app, ui::Ui& ui) {
    if (ui::menu_item(ui, {.label = "Adapt the resolution while moving", .checked = app.view.adaptive})) {
        app.view.adaptive = true;
        app.scene_changed();
    }
    for (const int percent : {50, 75, 100}) {
        const std::string label = fmt::format("{} % while moving", percent);
        const double scale = percent / 100.0;
        const bool chosen = !app.view.adaptive && app.view.fixed_scale == scale;
        if (!ui::menu_item(ui, {.label = label, .checked = chosen})) continue;
        app.view.adaptive = false;
        app.view.fixed_scale = scale;
        app.scene_changed();
    }
}

// The size of the virtual texture and the format of its pages: the picture keeps its texels until the new ones are made.
void quality_items(App& app, ui::Ui& ui) {
    for (const QualityName& level : quality_names()) {
        const std::string label = fmt::format("Texture quality: {}", level.title);
        if (ui::menu_item(ui, {.label = label, .checked = app.view.quality == level.quality}))
            app.change_quality(level.quality, app.view.page_format);
    }
    for (const PageFormatName& format : page_format_names()) {
        const std::string label = fmt::format("Texture pages: {}", format.title);
        if (ui::menu_item(ui, {.label = label, .checked = app.view.page_format == format.format}))
            app.change_quality(app.view.quality, format.format);
    }
}

void view_menu(App& app, ui::Ui& ui) {
    action_item(app, ui, "Whole map", "home");
    action_item(app, ui, "Frame the spot under the cursor", "frame");
    action_item(app, ui, "Stay above the ground", "above ground", ui::Icon::none, true, app.camera.keep_above_ground);
    ui::menu_separator(ui);
    action_item(app, ui, "Direct shading", "direct shading", ui::Icon::none, true,
                app.view.shading == Shading::direct);
    resolution_items(app, ui);
    ui::menu_separator(ui);
    if (ui::menu_item(ui, {.label = "Brush outline", .checked = app.view.show_ring}))
        app.view.show_ring = !app.view.show_ring;
    ui::menu_separator(ui);
    quality_items(app, ui);
    ui::menu_separator(ui);
    action_item(app, ui, "Timeline", "timeline", ui::Icon::none, true, app.show_timeline);
    action_item(app, ui, "Decal functions", "functions", ui::Icon::none, true, app.show_functions);
}

void debug_menu(App& app, ui::Ui& ui) {
    for (const DebugViewInfo& debug : debug_views()) {
        if (ui::menu_item(ui, {.label = debug.title, .checked = app.view.debug == debug.view})) {
            app.view.debug = debug.view;
            app.scene_changed();
        }
        if (debug.view == DebugView::none || debug.view == DebugView::heights) ui::menu_separator(ui);
    }
}

void tools_menu(App& app, ui::Ui& ui) {
    for (int i = 0; i < kToolCount; ++i)
        action_item(app, ui, tool_title(Tool(i)), tool_name(Tool(i)), tool_icon(Tool(i)), true,
                    app.tools.tool == Tool(i));
    ui::menu_separator(ui);
    action_item(app, ui, "Smaller brush", "smaller");
    action_item(app, ui, "Larger brush", "larger");
    action_item(app, ui, "Weaker brush", "weaker");
    action_item(app, ui, "Stronger brush", "stronger");
}

} // namespace

void build_menus(App& app, ui::Ui& ui) {
    auto top = ui::panel(ui, "menus", {.edge = ui::Edge::top, .size = 32, .horizontal = true, .padding = 4});
    auto bar = ui::menu_bar(ui);
    if (auto menu = ui::menu(ui, "File")) file_menu(app, ui);
    if (auto menu = ui::menu(ui, "Edit")) edit_menu(app, ui);
    if (auto menu = ui::menu(ui, "View")) view_menu(app, ui);
    if (auto menu = ui::menu(ui, "Debug")) debug_menu(app, ui);
    if (auto menu = ui::menu(ui, "Tools")) tools_menu(app, ui);
    if (auto menu = ui::menu(ui, "Help")) action_item(app, ui, "Keyboard and mouse", "shortcuts", ui::Icon::info);
}

} // namespace loam::window
