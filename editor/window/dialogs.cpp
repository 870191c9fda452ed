#include "editor/window/panels.h"

namespace loam::window {

namespace {

constexpr std::string_view kHelp[][2] = {
    {"Left button", "the tool in use"},
    {"Right button, W A S D, Q E", "fly; the wheel sets the speed, Shift is faster"},
    {"Alt and left button", "orbit around the ground under the cursor"},
    {"Middle button, Alt and Shift and left", "pan"},
    {"Wheel", "zoom towards the cursor"},
    {"Ctrl and wheel, [ and ]", "size of the brush"},
    {"Shift and [ and ]", "strength"},
    {"1 … 9, 0, C, E", "tools; also R, L, B"},
    {"Enter, Escape", "end the road that is being drawn, drop it; let go of the chosen object"},
    {"Ctrl while pressing", "raise: lower; flatten: pick a height; paint: pick a layer; cutout: close"},
    {"Shift while pressing", "smooth"},
    {", and .", "previous and next layer"},
    {"F, Home", "frame the spot under the cursor, the whole map"},
    {"Ctrl+F", "fill the map as the paint tool is set"},
    {"Space, T", "play the time or stop it, show the timeline"},
    {"F4", "write the functions of decals"},
    {"Left button on a dot", "move, turn or size the object chosen in the list"},
    {"Delete", "remove the object chosen in the list"},
    {"Ctrl+Z, Ctrl+Y", "undo, redo"},
    {"Ctrl+L", "add a layer from a folder of maps"},
    {"G, F3", "stay above the ground, direct shading"},
};

void help_dialog(ui::Ui& ui) {
    auto dialog = ui::dialog(ui, "Keyboard and mouse", 680);
    if (!dialog) return;
    for (const auto& [keys, what] : kHelp) {
        auto row = ui.row({ui::flex(0.4f), ui::flex(0.6f)}, 20);
        ui::label(ui, keys);
        ui::label(ui, what, ui::Tone::dim);
    }
    ui.space(8);
    (void)ui::dialog_buttons(ui, {"Close"});
}

void open_dialog(App& app, ui::Ui& ui) {
    auto dialog = ui::dialog(ui, "Open project", 480);
    if (!dialog) return;
    ui::text_field(ui, "Folder", app.path_text, {.placeholder = "a folder with project.toml"});
    ui.space(8);
    if (ui::dialog_buttons(ui, {"Cancel", "Open"}) != 1) return;
    // Looked at before the open project is let go.
    if (const auto settings = load_project(app.path_text); !settings) return app.fail(settings.message());
    app.wish = {.kind = Wish::Kind::open_project, .path = app.path_text};
}

void record_dialog(App& app, ui::Ui& ui) {
    auto dialog = ui::dialog(ui, "Record script", 480);
    if (!dialog) return;
    ui::paragraph(ui, "Every command from now on is added to this file, one line each; loam replay runs it.",
                  ui::Tone::dim);
    ui::text_field(ui, "File", app.path_text);
    ui.space(8);
    if (ui::dialog_buttons(ui, {"Cancel", "Record"}) != 1) return;
    if (const Status status = app.session.record_to(app.path_text); !status) return app.fail(status.message());
    app.say(fmt::format("Recording to {}", app.path_text));
}

void export_dialog(App& app, ui::Ui& ui) {
    auto dialog = ui::dialog(ui, "Export picture", 480);
    if (!dialog) return;
    ui::text_field(ui, "File", app.path_text);
    ui::slider(ui, "Width", app.export_width, {.min = 64, .max = 7680, .unit = "px"});
    ui::slider(ui, "Height", app.export_height, {.min = 64, .max = 4320, .unit = "px"});
    ui.space(8);
    if (ui::dialog_buttons(ui, {"Cancel", "Export"}) != 1) return;
    app.wish = {.kind = Wish::Kind::export_picture, .path = app.path_text, .width = app.export_width,
                .height = app.export_height};
}

void add_layer_dialog(App& app, ui::Ui& ui) {
    auto dialog = ui::dialog(ui, "Add layer", 480);
    if (!dialog) return;
    ui::paragraph(ui, "A folder of maps by the usual names: …_Color, _NormalGL, _Roughness, _Displacement and so on.",
                  ui::Tone::dim);
    ui::text_field(ui, "Folder", app.path_text);
    ui::text_field(ui, "Name", app.new_layer_name, {.placeholder = "as the folder"});
    ui::slider(ui, "Tile", app.new_layer_tile_m, {.min = 0.1, .max = 100, .decimals = 2, .unit = "m", .logarithmic = true,
                                                  .tooltip = "Metres of ground that the maps cover"});
    ui.space(8);
    if (ui::dialog_buttons(ui, {"Cancel", "Add"}) != 1) return;
    app.import_layer(
        {.pack = {.folder = app.path_text}, .name = app.new_layer_name, .tile_m = app.new_layer_tile_m});
}

void add_stamp_dialog(App& app, ui::Ui& ui) {
    auto dialog = ui::dialog(ui, "Add stamp", 480);
    if (!dialog) return;
    ui::paragraph(ui, "Any picture: its brightness is the height, its alpha where there is any of it.",
                  ui::Tone::dim);
    ui::text_field(ui, "File", app.path_text);
    ui::text_field(ui, "Name", app.new_stamp_name, {.placeholder = "as the file"});
    ui.space(8);
    if (ui::dialog_buttons(ui, {"Cancel", "Add"}) == 1) app.import_stamp(app.path_text, app.new_stamp_name);
}

void add_imagery_dialog(App& app, ui::Ui& ui) {
    auto dialog = ui::dialog(ui, "Add imagery", 480);
    if (!dialog) return;
    ui::paragraph(
        ui,
        "A satellite or ortho picture of the whole map, of any size: its corners are the map's, its top is "
        "north. It is the ground's far look.",
        ui::Tone::dim);
    ui::text_field(ui, "File", app.path_text);
    ui.space(8);
    if (ui::dialog_buttons(ui, {"Cancel", "Add"}) == 1) app.import_imagery(app.path_text);
}

// While a fill goes on nothing else is edited: it is one step of the history. Closing the dialog takes it
// back.
void fill_dialog(App& app, ui::Ui& ui) {
    if (!ui::dialog_open(ui, kFillDialog)) {
        app.cancel_fill();
        return;
    }
    if (!app.filling()) return ui::close_dialog(ui, kFillDialog);
    auto dialog = ui::dialog(ui, kFillDialog, 360);
    if (!dialog) return;
    ui::label(ui, fmt::format("{:.0f} %", 100 * app.filled_share()));
    ui.space(8);
    ui::dialog_buttons(ui, {"Cancel"});
}

} // namespace

void build_dialogs(App& app, ui::Ui& ui) {
    help_dialog(ui);
    open_dialog(app, ui);
    record_dialog(app, ui);
    export_dialog(app, ui);
    add_layer_dialog(app, ui);
    add_stamp_dialog(app, ui);
    new_function_dialog(app, ui);
    add_imagery_dialog(app, ui);
    fill_dialog(app, ui);
    for (const std::string& text : app.take_errors()) ui.toast(text, ui.theme.error, 8);
}

} // namespace loam::window
