// Parameters of events: of the next one that the event tool places, and of the selected one, which the ground
// follows while they are dragged.
#include <cmath>

#include "editor/window/panels.h"

namespace loam::window {

namespace {

bool seconds_slider(ui::Ui& ui, std::string_view label, double& seconds, std::string_view tooltip = {}) {
    return ui::slider(ui, label, seconds,
                      {.min = 0, .max = 600, .decimals = 1, .unit = "s", .tooltip = tooltip})
        .changed;
}

bool metres_slider(ui::Ui& ui, std::string_view label, double& metres, double min_m, double max_m) {
    return ui::slider(ui, label, metres,
                      {.min = min_m, .max = max_m, .decimals = 1, .unit = "m", .logarithmic = true})
        .changed;
}

bool impact_sliders(ui::Ui& ui, Event& event, std::string_view label) {
    double radius_m = crater_radius_m(event.energy_j);
    bool changed = metres_slider(ui, label, radius_m, 0.2, 1000);
    if (changed) event.energy_j = crater_energy_j(radius_m);
    const double kilograms = event.energy_j / 4.184e6;
    ui::label(ui,
              kilograms < 1000 ? fmt::format("{:.1f} kg of TNT", kilograms)
                               : fmt::format("{:.1f} t of TNT", kilograms / 1000),
              ui::Tone::dim);
    changed |= seconds_slider(ui, "Cools in", event.cool_s, "0: it never cools");
    changed |= seconds_slider(ui, "Weathers in", event.weather_s, "0: it stays fresh");
    return changed;
}

bool count_slider(ui::Ui& ui, std::string_view label, int& count, int most) {
    double number = count;
    const bool changed =
        ui::slider(ui, label, number,
                   {.min = 1, .max = double(most), .step = 1, .decimals = 0, .logarithmic = true})
            .changed;
    if (changed) count = int(std::lround(number));
    return changed;
}

}  // namespace

bool event_sliders(ui::Ui& ui, Event& event) {
    bool changed = false;
    switch (event.kind) {
        case EventKind::crater:
            changed |= impact_sliders(ui, event, "Radius");
            break;
        case EventKind::crater_line:
            changed |= impact_sliders(ui, event, "Largest radius");
            changed |= count_slider(ui, "Craters", event.count, 200);
            break;
        case EventKind::barrage:
            changed |= metres_slider(ui, "Half side", event.radius_m, 5, 2000);
            changed |= impact_sliders(ui, event, "Largest radius");
            changed |= count_slider(ui, "Craters", event.count, 5000);
            break;
        case EventKind::crash:
            changed |= metres_slider(ui, "Width", event.width_m, 0.5, 50);
            changed |= count_slider(ui, "Debris", event.count, 500);
            changed |= seconds_slider(ui, "Burns for", event.cool_s, "0: for ever");
            break;
        case EventKind::landslide:
            changed |= metres_slider(ui, "Radius", event.radius_m, 2, 500);
            changed |= ui::slider(ui, "Volume", event.volume_m3,
                                  {.min = 1, .max = 1e7, .decimals = 0, .unit = "m³", .logarithmic = true})
                           .changed;
            break;
        case EventKind::flood:
            changed |= metres_slider(ui, "Radius", event.radius_m, 5, 5000);
            break;
    }
    changed |= seconds_slider(ui, "Takes", event.duration_s, "From its start until it is done");
    return changed;
}

void event_tool_properties(App& app, ui::Ui& ui) {
    ToolSettings& settings = app.tools.settings;
    std::vector<std::string_view> names;
    for (int i = 0; i < kEventKinds; ++i) names.push_back(title_of(EventKind(i)));
    int kind = int(settings.event_kind);
    ui::combo(ui, "Event", kind, names);
    settings.event_kind = EventKind(kind);
    Event& event = settings.events[size_t(kind)];
    event_sliders(ui, event);
    if (event.kind == EventKind::flood)
        ui::slider(ui, "Rises by", settings.flood_rise_m,
                   {.min = 0.1,
                    .max = 200,
                    .decimals = 1,
                    .unit = "m",
                    .logarithmic = true,
                    .tooltip = "Above the ground where it is placed"});
    constexpr std::string_view kHints[kEventKinds] = {
        "Click where it strikes",
        "Drag from the first crater to the last",
        "Click in its middle",
        "Drag from where it touches down to where it comes to rest",
        "Click, and it runs downhill; drag to say where to",
        "Click where the water shall come from"};
    ui::paragraph(ui, kHints[kind], ui::Tone::dim);
    ui::checkbox(ui, "Play at once", app.play_placed);
}

// Under the outliner's list.
void selected_event_properties(App& app, ui::Ui& ui) {
    const Operator* op = app.selected_operator();
    const auto* found = op ? std::get_if<Event>(&op->shape) : nullptr;
    if (!found) return;
    Event event = *found;
    ui::separator(ui);
    ui.push_id(fmt::format("event{}", op->id));
    bool changed = event_sliders(ui, event);
    changed |= ui::slider(ui, "Starts at", event.start_s, {.min = 0, .max = 600, .decimals = 1, .unit = "s"})
                   .changed;
    if (event.kind == EventKind::flood)
        changed |=
            ui::slider(ui, "Level", event.level_m, {.min = -500, .max = 4000, .decimals = 1, .unit = "m"})
                .changed;
    int seed = int(event.seed);
    if (ui::slider(ui, "Seed", seed, {.min = 0, .max = 9999})) event.seed = uint32_t(seed), changed = true;
    ui.pop_id();
    app.edit_selected(changed ? std::optional<OperatorShape>(event) : std::nullopt, ui);
}

}  // namespace loam::window
