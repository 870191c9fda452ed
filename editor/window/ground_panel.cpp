// How the layers are laid over the ground: transitions between them, distortion, tile hiding.
#include <algorithm>

#include "editor/window/panels.h"

namespace loam::window {

// The selected layer's, if it is one; and what makes another.
void transition_properties(App& app, ui::Ui& ui) {
    const ProjectSettings settings = app.session.document().settings();
    const int selected = app.layer();
    if (selected >= 0 && settings.layers[size_t(selected)].blend) {
        const LayerEntry& entry = settings.layers[size_t(selected)];
        ui::label(ui, fmt::format("{} to {}", entry.blend->from, entry.blend->to));
        double percent = entry.blend->threshold * 100;
        const auto moved = ui::slider(ui, "Threshold", percent,
                                      {.min = 0,
                                       .max = 100,
                                       .decimals = 0,
                                       .unit = "%",
                                       .tooltip = "How much of the second layer shows"});
        if (moved) {  // one step of the history a drag
            if (app.transition_group == 0) app.transition_group = app.session.document().next_group();
            app.apply(
                {.body =
                     TransitionCommand{.name = entry.name, .from = {}, .to = {}, .threshold = percent / 100},
                 .group = app.transition_group});
        }
        if (moved.finished) app.transition_group = 0;
        if (ui::button(ui, "Remove transition", {.tooltip = "Its ground shows the nearer of the two layers"}))
            app.apply({.body = TransitionCommand{
                           .name = entry.name, .from = {}, .to = {}, .threshold = {}, .remove = true}});
        ui::separator(ui);
    }
    std::vector<std::string_view> sides;
    for (const LayerEntry& layer : settings.layers)
        if (!layer.blend) sides.push_back(layer.name);
    if (sides.size() < 2) return ui::label(ui, "A transition needs two layers", ui::Tone::dim);
    const int last = int(sides.size()) - 1;
    app.transition_from = std::clamp(app.transition_from, 0, last);
    app.transition_to = std::clamp(app.transition_to, 0, last);
    ui::combo(ui, "From", app.transition_from, sides);
    ui::combo(ui, "To", app.transition_to, sides);
    if (!ui::button(ui, "Make transition")) return;
    const std::string from(sides[size_t(app.transition_from)]), to(sides[size_t(app.transition_to)]);
    const std::string name = fmt::format("{} to {}", from, to);
    if (!app.apply({.body = TransitionCommand{.name = name, .from = from, .to = to, .threshold = {}}}))
        return;
    app.set_layer(int(std::find(app.layer_names.begin(), app.layer_names.end(), name) - app.layer_names.begin()));
}

void ground_properties(App& app, ui::Ui& ui) {
    ProjectSettings settings = app.session.document().settings();
    GroundSettings& ground = settings.ground;
    ui::slider(ui, "Distortion", ground.distortion_amplitude_m,
               {.min = 0, .max = settings.index_spacing_m, .decimals = 2, .unit = "m",
                .tooltip = "How far borders between layers waver; at most a texel of the index map"});
    ui.push_disabled(ground.distortion_amplitude_m <= 0);
    ui::slider(ui, "Period", ground.distortion_period_m,
               {.min = 4, .max = 256, .decimals = 0, .unit = "m", .logarithmic = true,
                .tooltip = "After which the wavering repeats: smaller is busier"});
    ui.pop_disabled();
    ui::checkbox(ui, "Hide tiling", ground.tile_hiding);
    ui::slider(
        ui, "Vista", ground.vista_scale,
        {.min = kVistaScale.min,
         .max = kVistaScale.max,
         .decimals = 1,
         .unit = "x",
         .logarithmic = true,
         .tooltip =
             "How much larger textures show from afar, so that ground keeps a structure there; 1 is off"});
    ui.push_disabled(!ground.has_vista());
    ui::slider(ui, "Vista from", ground.vista_distance_m,
               {.min = kVistaDistance_m.min,
                .max = kVistaDistance_m.max,
                .decimals = 0,
                .unit = "m",
                .logarithmic = true,
                .tooltip = "Where the larger lookup begins; from four times that on it is alone"});
    ui.pop_disabled();
    if (ground != app.session.document().settings().ground) app.change_settings(settings);
}

void imagery_properties(App& app, ui::Ui& ui) {
    ProjectSettings settings = app.session.document().settings();
    ImagerySettings& imagery = settings.imagery;
    if (imagery.file.empty()) {
        if (ui::button(ui, "Add imagery…", {.tooltip = "A picture of the whole map as its far look"}))
            app.run("add imagery", ui);
        return;
    }
    ui::label(ui, std::filesystem::path(imagery.file).stem().string());
    double percent = imagery.strength * 100;
    if (ui::slider(ui, "Strength", percent, {.min = 0, .max = 100, .decimals = 0, .unit = "%"}))
        imagery.strength = percent / 100;
    ui::slider(ui, "From", imagery.distance_m,
               {.min = kImageryDistance_m.min,
                .max = kImageryDistance_m.max,
                .decimals = 0,
                .unit = "m",
                .logarithmic = true,
                .tooltip = "Where it begins to show; from four times that on it is alone"});
    if (ui::button(ui, "Replace imagery…")) app.run("add imagery", ui);
    if (ui::button(ui, "Remove imagery", {.tooltip = "Its file stays in the project's folder"}))
        imagery.file.clear();
    if (imagery != app.session.document().settings().imagery) app.change_settings(settings);
}

} // namespace loam::window
