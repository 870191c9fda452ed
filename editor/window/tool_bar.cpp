#include "editor/window/panels.h"

namespace loam::window {

ui::Icon tool_icon(Tool tool) {
    switch (tool) {
        case Tool::raise: return ui::Icon::raise;
        case Tool::lower: return ui::Icon::lower;
        case Tool::smooth: return ui::Icon::smooth;
        case Tool::flatten: return ui::Icon::flatten;
        case Tool::paint: return ui::Icon::paint;
        case Tool::crater: return ui::Icon::crater;
        case Tool::footprints: return ui::Icon::footprints;
        case Tool::decal: return ui::Icon::decal;
        case Tool::road: return ui::Icon::road;
        case Tool::stamp:
            return ui::Icon::stamp;
        case Tool::cutout:
            return ui::Icon::cutout;
        case Tool::event:
            return ui::Icon::event;
    }
    return ui::Icon::none;
}

namespace {

std::string_view tool_hint(Tool tool) {
    switch (tool) {
        case Tool::raise: return "Raise the ground. Ctrl lowers, Shift smooths";
        case Tool::lower: return "Lower the ground. Ctrl raises, Shift smooths";
        case Tool::smooth: return "Smooth the ground";
        case Tool::flatten: return "Flatten to the height where the stroke begins. Ctrl-click picks a height";
        case Tool::paint: return "Paint a layer. Ctrl-click picks the layer";
        case Tool::crater: return "Click for a crater, drag for its size";
        case Tool::footprints: return "Drag to walk";
        case Tool::decal: return "Lay a piece of the chosen layer: click, or drag to turn it";
        case Tool::road: return "Click place by place, drag a place to move it. Enter, or a click on the last, ends";
        case Tool::stamp:
            return "Lay a picture as height: click, or drag to turn it";
        case Tool::cutout:
            return "Cut a hole into the ground. Ctrl closes it again";
        case Tool::event:
            return "Set off an event: an impact, a crash, a landslide, a flood";
    }
    return {};
}

void action_button(App& app, ui::Ui& ui, std::string_view action, ui::Icon icon, std::string_view hint, bool toggled,
                   bool enabled = true) {
    const std::string shortcut = app.shortcuts.label(action);
    ui.push_disabled(!enabled);
    if (ui::icon_button(ui, action, {.icon = icon, .toggled = toggled, .tooltip = hint, .shortcut = shortcut}))
        app.run(action, ui);
    ui.pop_disabled();
}

} // namespace

void build_tool_bar(App& app, ui::Ui& ui) {
    auto bar = ui::panel(ui, "tools", {.edge = ui::Edge::left, .size = 44, .padding = 6});
    for (int i = 0; i < kToolCount; ++i) {
        if (Tool(i) == Tool::paint || Tool(i) == Tool::crater) ui::separator(ui);
        action_button(app, ui, tool_name(Tool(i)), tool_icon(Tool(i)), tool_hint(Tool(i)), app.tools.tool == Tool(i));
    }
    ui::separator(ui);
    action_button(app, ui, "undo", ui::Icon::undo, "Undo", false, app.session.document().can_undo());
    action_button(app, ui, "redo", ui::Icon::redo, "Redo", false, app.session.document().can_redo());
}

} // namespace loam::window
