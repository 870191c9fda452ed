// The right panel: properties of the tool, layers, sun, history.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "editor/window/panels.h"

namespace loam::window {

namespace {

constexpr double kDegrees = 180 / M_PI;

void brush_properties(ui::Ui& ui, Brush& brush, bool with_strength) {
    ui::slider(ui, "Radius", brush.radius_m,
               {.min = ToolController::kSmallestRadius_m, .max = ToolController::kLargestRadius_m, .decimals = 2,
                .unit = "m", .logarithmic = true, .tooltip = "[ and ], or Ctrl and the wheel"});
    if (!with_strength) return;
    double percent = brush.strength * 100;
    if (ui::slider(ui, "Strength", percent, {.min = 1, .max = 100, .decimals = 0, .unit = "%"}))
        brush.strength = percent / 100;
    percent = brush.hardness * 100;
    if (ui::slider(ui, "Hardness", percent, {.min = 0, .max = 100, .decimals = 0, .unit = "%"}))
        brush.hardness = percent / 100;
}

void mask_properties(ui::Ui& ui, GroundMask& mask) {
    double low = mask.min_slope_rad * kDegrees, high = mask.max_slope_rad * kDegrees;
    const ui::SliderDesc desc{.min = 0, .max = 90, .decimals = 0, .unit = "°"};
    if (ui::slider(ui, "Slope from", low, desc)) mask.min_slope_rad = std::min(low, high) / kDegrees;
    if (ui::slider(ui, "Slope to", high, desc)) mask.max_slope_rad = std::max(low, high) / kDegrees;
    // The ends of the sliders are no limit.
    constexpr double kLow_m = -1000, kHigh_m = 9000;
    const ui::SliderDesc metres{.min = kLow_m,
                                .max = kHigh_m,
                                .decimals = 0,
                                .unit = "m",
                                .tooltip = "At either end there is no limit"};
    double lowest = std::max(mask.min_height_m, kLow_m), highest = std::min(mask.max_height_m, kHigh_m);
    const auto limited = [&](double at_m) {
        return at_m <= kLow_m ? -GroundMask::kHighest_m : at_m >= kHigh_m ? GroundMask::kHighest_m : at_m;
    };
    if (ui::slider(ui, "Height from", lowest, metres)) mask.min_height_m = limited(std::min(lowest, highest));
    if (ui::slider(ui, "Height to", highest, metres)) mask.max_height_m = limited(std::max(lowest, highest));
    double percent = mask.noise * 100;
    if (ui::slider(ui, "Noise", percent,
                   {.min = 0,
                    .max = 100,
                    .decimals = 0,
                    .unit = "%",
                    .tooltip = "Leaves patches of the ground out"}))
        mask.noise = percent / 100;
    ui.push_disabled(mask.noise <= 0);
    ui::slider(ui, "Noise size", mask.noise_size_m,
               {.min = 0.5, .max = 5000, .decimals = 1, .unit = "m", .logarithmic = true});
    ui.pop_disabled();
}

void tint_properties(ui::Ui& ui, ToolSettings& settings) {
    ui::checkbox(ui, "Tint", settings.use_tint);
    if (!settings.use_tint) return;
    const ui::SliderDesc desc{.min = 0, .max = 1, .decimals = 2};
    ui::slider(ui, "Red", settings.tint.x, desc);
    ui::slider(ui, "Green", settings.tint.y, desc);
    ui::slider(ui, "Blue", settings.tint.z, desc);
}

void crater_properties(ui::Ui& ui, App& app) {
    ToolSettings& settings = app.tools.settings;
    brush_properties(ui, app.tools.brush(), false);
    double percent = settings.crater_depth_share * 100;
    if (ui::slider(ui, "Depth", percent,
                   {.min = 5, .max = 100, .decimals = 0, .unit = "%", .tooltip = "Of the radius"}))
        settings.crater_depth_share = percent / 100;
    double heat_percent = settings.crater_heat * 100;
    if (ui::slider(ui, "Heat", heat_percent,
                   {.min = 0, .max = 100, .decimals = 0, .unit = "%", .tooltip = "Embers, on maps with the emissive or thermal channel"}))
        settings.crater_heat = heat_percent / 100;
    int seed = static_cast<int>(settings.seed);
    if (ui::slider(ui, "Seed", seed, {.min = 1, .max = 9999, .tooltip = "Each crater has its own shape"}))
        settings.seed = static_cast<uint32_t>(seed);
}

void gait_properties(ui::Ui& ui, GaitDesc& gait) {
    ui::slider(ui, "Foot", gait.length_m, {.min = 0.05, .max = 5, .decimals = 2, .unit = "m", .logarithmic = true});
    ui::slider(ui, "Depth", gait.depth_m, {.min = 0.002, .max = 0.5, .decimals = 3, .unit = "m", .logarithmic = true});
    ui::slider(ui, "Step", gait.step_share,
               {.min = 1.2, .max = 6, .decimals = 1, .unit = "feet", .tooltip = "From one foot to the next"});
}

bool share_slider(ui::Ui& ui, std::string_view label, double& share) {
    double percent = share * 100;
    if (!ui::slider(ui, label, percent, {.min = 0, .max = 100, .decimals = 0, .unit = "%"})) return false;
    share = percent / 100;
    return true;
}

void decal_properties(ui::Ui& ui, App& app) {
    DecalDesc& decal = app.tools.settings.decal;
    brush_properties(ui, app.tools.brush(), true);
    ui::slider(ui, "Stretch", decal.stretch, {.min = 0.1, .max = 10, .decimals = 2, .logarithmic = true});
    share_slider(ui, "Rough edge", decal.rough);
    ui::checkbox(ui, "Round", decal.ellipse);
    ui::slider(ui, "Displacement", decal.displacement_m, kDisplacement);
    tint_properties(ui, app.tools.settings);
    function_properties(app, ui, app.tools.settings.function, app.tools.settings.parameters);
}

void road_properties(ui::Ui& ui, App& app) {
    RoadDesc& road = app.tools.settings.road;
    Brush& brush = app.tools.brush();
    double width_m = 2 * brush.radius_m;
    if (ui::slider(ui, "Width", width_m, {.min = 0.2, .max = 100, .decimals = 1, .unit = "m", .logarithmic = true}))
        brush.radius_m = width_m / 2;
    share_slider(ui, "Opacity", brush.strength);
    share_slider(ui, "Soft edge", road.edge);
    ui::checkbox(ui, "Carve the ground", road.carve);
    ui.push_disabled(!road.carve);
    ui::slider(ui, "Shoulder", road.shoulder_m, {.min = 0, .max = 50, .decimals = 1, .unit = "m"});
    ui.pop_disabled();
    tint_properties(ui, app.tools.settings);
    function_properties(app, ui, app.tools.settings.function, app.tools.settings.parameters);
}

void stamp_properties(ui::Ui& ui, App& app) {
    StampDesc& stamp = app.tools.settings.stamp;
    const std::vector<std::string_view> names(app.stamp_names.begin(), app.stamp_names.end());
    if (names.empty()) {
        ui::label(ui, "The project has no stamps", ui::Tone::dim);
    } else {
        int which = std::max(0, int(std::find(names.begin(), names.end(), stamp.image) - names.begin()));
        if (which >= int(names.size())) which = 0;
        ui::combo(ui, "Stamp", which, names);
        stamp.image = app.stamp_names[size_t(which)];
    }
    if (ui::button(ui, "Add stamp…")) app.run("add stamp", ui);
    brush_properties(ui, app.tools.brush(), true);
    ui::slider(ui, "Stretch", stamp.stretch, {.min = 0.1, .max = 10, .decimals = 2, .logarithmic = true});
    constexpr std::string_view kModes[] = {"Add", "Higher of both", "Lower of both", "Replace"};
    int mode = int(stamp.mode);
    ui::combo(ui, "Mode", mode, kModes);
    stamp.mode = StampMode(mode);
    ui::slider(ui, "Height", stamp.height_m,
               {.min = -500, .max = 500, .decimals = 1, .unit = "m", .tooltip = "Of white above black"});
    ui::checkbox(ui, "Lay the layer", stamp.lay_layer);
    ui.push_disabled(!stamp.lay_layer);
    share_slider(ui, "From", stamp.layer_from);
    ui.pop_disabled();
    ui::checkbox(ui, "Colours", stamp.colour);
}

void cutout_properties(ui::Ui& ui, App& app) {
    CutoutDesc& cutout = app.tools.settings.cutout;
    constexpr std::string_view kForms[] = {"Brush", "Box", "Cylinder"};
    constexpr CutoutForm kFormOf[] = {CutoutForm::brush, CutoutForm::box, CutoutForm::cylinder};
    int form = int(std::find(std::begin(kFormOf), std::end(kFormOf), cutout.form) - std::begin(kFormOf));
    ui::combo(ui, "Form", form, kForms);
    cutout.form = kFormOf[form];
    brush_properties(ui, app.tools.brush(), false);
    ui.push_disabled(cutout.form == CutoutForm::brush);
    ui::slider(ui, "Stretch", cutout.stretch, {.min = 0.1, .max = 10, .decimals = 2, .logarithmic = true});
    ui::slider(ui, "Depth", cutout.depth_m,
               {.min = 0.1,
                .max = 500,
                .decimals = 1,
                .unit = "m",
                .logarithmic = true,
                .tooltip = "Below the ground and above it"});
    ui.pop_disabled();
    ui::paragraph(ui, "Ctrl closes holes", ui::Tone::dim);
}

// The whole map, or all of one layer, under the paint tool's masks.
void fill_properties(ui::Ui& ui, App& app) {
    std::vector<std::string_view> names{"every layer"};
    names.insert(names.end(), app.layer_names.begin(), app.layer_names.end());
    app.replaced_layer = std::clamp(app.replaced_layer, 0, int(names.size()) - 1);
    ui::combo(ui, "Replace", app.replaced_layer, names);
    ui.push_disabled(app.filling() || (app.tools.settings.layer.empty() && !app.tools.settings.use_tint));
    if (ui::button(ui, "Fill the map")) app.run("fill", ui);
    ui.pop_disabled();
}

void tool_properties(App& app, ui::Ui& ui) {
    ToolSettings& settings = app.tools.settings;
    ui.push_id(tool_name(app.tools.tool));
    switch (app.tools.tool) {
        case Tool::raise:
        case Tool::lower:
        case Tool::smooth:
            brush_properties(ui, app.tools.brush(), true);
            break;
        case Tool::flatten:
            brush_properties(ui, app.tools.brush(), true);
            ui::checkbox(ui, "Fixed height", settings.flatten_fixed);
            ui.push_disabled(!settings.flatten_fixed);
            ui::slider(ui, "Height", settings.flatten_target_m,
                       {.min = -1000, .max = 9000, .decimals = 2, .unit = "m"});
            ui.pop_disabled();
            break;
        case Tool::paint:
            brush_properties(ui, app.tools.brush(), true);
            mask_properties(ui, settings.mask);
            tint_properties(ui, settings);
            ui::checkbox(ui, "Transitions", settings.transitions);
            fill_properties(ui, app);
            break;
        case Tool::crater: crater_properties(ui, app); break;
        case Tool::footprints: gait_properties(ui, settings.gait); break;
        case Tool::decal: decal_properties(ui, app); break;
        case Tool::road: road_properties(ui, app); break;
        case Tool::cutout:
            cutout_properties(ui, app);
            break;
        case Tool::stamp:
            stamp_properties(ui, app);
            break;
        case Tool::event:
            event_tool_properties(app, ui);
            break;
    }
    ui.pop_id();
}

bool holds(std::string_view name, std::string_view searched) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(name.begin(), name.end(), searched.begin(), searched.end(), same) != name.end();
}

// The selected layer one place further in the palette, or before; its number in the map stays.
void move_in_palette(App& app, int step) {
    ProjectSettings settings = app.session.document().settings();
    std::vector<int> order = palette_order(settings);
    const auto at = std::find(order.begin(), order.end(), app.layer());
    const auto to = at - order.begin() + step;
    if (at == order.end() || to < 0 || to >= std::ssize(order)) return;
    std::iter_swap(at, order.begin() + to);
    settings.palette.clear();
    for (const int layer : order) settings.palette.push_back(settings.layers[size_t(layer)].name);
    app.change_settings(settings);
}

// What the layer's textures are laid with; the ground follows the sliders.
void layer_properties(App& app, ui::Ui& ui) {
    ProjectSettings settings = app.session.document().settings();
    const int selected = app.layer();
    if (selected < 0 || settings.layers[size_t(selected)].blend) return;
    LayerEntry& entry = settings.layers[size_t(selected)];
    ui::label(ui, fmt::format("{}, number {} in the map", entry.name, selected), ui::Tone::dim);
    bool changed = ui::slider(ui, "Tile", entry.tile_m,
                              {.min = 0.1,
                               .max = 100,
                               .decimals = 2,
                               .unit = "m",
                               .logarithmic = true,
                               .tooltip = "Metres of ground that its textures cover before they repeat"})
                       .changed;
    changed |= share_slider(ui, "Softness", entry.softness);  // underfoot
    constexpr std::array<std::string_view, kChannelNames.size()> kLabels = {"Scattering", "Heat", "Emissive",
                                                                            "Glint", "Depth"};
    for (const Channel channel : settings.channels)
        changed |= share_slider(ui, kLabels[size_t(channel)], entry.channels[size_t(channel)]);
    if (changed) app.change_settings(settings);
    ui.push_disabled(!app.layer_search.empty());
    if (ui::button(ui, "Earlier in the palette")) move_in_palette(app, -1);
    if (ui::button(ui, "Later in the palette")) move_in_palette(app, 1);
    ui.pop_disabled();
}

void layer_palette(App& app, ui::Ui& ui) {
    if (app.layer_names.empty()) ui::label(ui, "The project has no layers", ui::Tone::dim);
    ui::text_field(ui, "##search", app.layer_search,
                   {.placeholder = "Search layers", .icon = ui::Icon::search});
    const std::vector<LayerEntry>& entries = app.session.document().settings().layers;
    std::vector<ui::Tile> tiles;
    std::vector<int> layers;  // by tile
    int selected = -1;
    for (const int i : palette_order(app.session.document().settings())) {
        if (!holds(app.layer_names[size_t(i)], app.layer_search)) continue;
        if (i == app.layer()) selected = int(layers.size());
        layers.push_back(i);
        tiles.push_back(
            {.caption = app.layer_names[size_t(i)],
             .texture = size_t(i) < app.layer_pictures.size() ? app.layer_pictures[size_t(i)] : 0});
    }
    if (tiles.empty() && !app.layer_search.empty())
        ui::label(ui, fmt::format("No layer has \"{}\" in its name", app.layer_search), ui::Tone::dim);
    if (ui::tile_grid(ui, "layers", tiles, selected, {.picture = 56})) {
        const size_t layer = size_t(layers[size_t(selected)]);
        app.set_layer(int(layer));
        const Tool tool = app.tools.tool;
        const bool lays = tool == Tool::decal || tool == Tool::road ||
                          (tool == Tool::stamp && app.tools.settings.stamp.lay_layer);
        if (!lays || entries[layer].blend) app.set_tool(Tool::paint); // a transition can only be painted
    }
    if (ui::button(ui, "Add layer…")) app.run("add layer", ui);
}

void sun_properties(App& app, ui::Ui& ui) {
    ProjectSettings settings = app.session.document().settings();
    double azimuth = std::remainder(settings.sun_azimuth_rad, 2 * M_PI) * kDegrees;
    if (azimuth < 0) azimuth += 360;
    double elevation = settings.sun_elevation_rad * kDegrees, haze = settings.haze_per_km;
    bool changed = ui::slider(ui, "Azimuth", azimuth,
                              {.min = 0, .max = 360, .decimals = 0, .unit = "°", .tooltip = "Clockwise from north"})
                       .changed;
    changed |= ui::slider(ui, "Elevation", elevation, {.min = 0, .max = 90, .decimals = 0, .unit = "°"}).changed;
    changed |= ui::slider(ui, "Haze", haze,
                          {.min = 0, .max = 0.5, .decimals = 3, .unit = "/km", .tooltip = "Extinction at sea level"})
                   .changed;
    if (!changed) return;
    settings.sun_azimuth_rad = azimuth / kDegrees;
    settings.sun_elevation_rad = elevation / kDegrees;
    settings.haze_per_km = haze;
    app.change_settings(settings);
}

// Newest first; a press goes there.
void history_row(App& app, ui::Ui& ui, const HistoryStep& step, bool current) {
    const ui::Theme& theme = ui.theme;
    const ui::Rect row = ui.allocate({0, ui.px(22)});
    const ui::Response r = ui.interact(ui.make_id(fmt::format("step{}", step.last_sequence)), row, ui::Sense::click);
    if (current) ui.draw().rect(row, theme.accent_soft, ui.px(3));
    else if (r.hovered) ui.draw().rect(row, theme.hover, ui.px(3));
    ui::Rect text = row.inset(ui.px(8), 0);
    const std::string count = step.command_count > 1 ? fmt::format("{}", step.command_count) : std::string();
    const ui::Color color = step.applied ? theme.text : theme.text_disabled;
    ui.draw_label(ui::cut(text, ui::Edge::right, ui.px(36)), count, ui.small_style(), theme.text_dim,
                  ui::Ui::Align::right);
    ui.draw_label(text, step.title, ui.style(), color);
    if (r.clicked) app.go_to(step.last_sequence);
}

void history_list(App& app, ui::Ui& ui) {
    const std::vector<HistoryStep> steps = app.history(); // by value: a press changes it
    if (steps.empty()) return ui::label(ui, "Nothing done yet", ui::Tone::dim);
    size_t current = steps.size();
    for (size_t i = 0; i < steps.size(); ++i)
        if (steps[i].applied) current = i;
    for (size_t i = steps.size(); i-- > 0;) history_row(app, ui, steps[i], i == current);
}

} // namespace

void build_properties(App& app, ui::Ui& ui) {
    auto panel = ui::panel(ui, "properties", {.edge = ui::Edge::right, .size = 276, .resizable = true, .scroll = true});
    const std::string title = fmt::format("{}##tool", tool_title(app.tools.tool));
    if (auto section = ui::section(ui, title)) tool_properties(app, ui);
    if (auto section = ui::section(ui, "Layers")) layer_palette(app, ui);
    if (auto section = ui::section(ui, "Layer", ui::Section::closed)) layer_properties(app, ui);
    if (auto section = ui::section(ui, "Transitions", ui::Section::closed)) transition_properties(app, ui);
    if (auto section = ui::section(ui, "Ground")) ground_properties(app, ui);
    if (auto section = ui::section(ui, "Imagery", ui::Section::closed)) imagery_properties(app, ui);
    if (auto section = ui::section(ui, "Sun")) sun_properties(app, ui);
    if (auto section = ui::section(ui, "Objects", ui::Section::closed)) object_properties(app, ui);
    if (auto section = ui::section(ui, "History")) history_list(app, ui);
}

} // namespace loam::window
