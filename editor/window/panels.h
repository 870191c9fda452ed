// The panels around the viewport. Each is built anew in every frame from the App, and changes it through its calls.
#pragma once

#include "editor/window/app.h"

namespace loam::window {

inline constexpr std::string_view kFillDialog = "Filling the map";
// Of a terrain decal.
inline constexpr ui::SliderDesc kDisplacement{
    .min = -3, .max = 3, .decimals = 2, .unit = "m", .tooltip = "Raises the ground under it, or lowers it"};

void build_menus(App& app, ui::Ui& ui);
void build_tool_bar(App& app, ui::Ui& ui);
void build_properties(App& app, ui::Ui& ui); // the right panel: tool, layers, sun, history
void transition_properties(App& app, ui::Ui& ui); // sections of it
void ground_properties(App& app, ui::Ui& ui);
void imagery_properties(App& app, ui::Ui& ui);
void object_properties(App& app, ui::Ui& ui);  // the outliner
void event_tool_properties(App& app, ui::Ui& ui);
void selected_event_properties(App& app, ui::Ui& ui);
void selected_decal_properties(App& app, ui::Ui& ui);
// Which function, and its parameters; whether something was changed.
bool function_properties(App& app, ui::Ui& ui, std::string& function,
                         std::map<std::string, double>& parameters);
void build_function_panel(App& app, ui::Ui& ui);
void new_function_dialog(App& app, ui::Ui& ui);
bool event_sliders(ui::Ui& ui, Event& event);  // what its kind has; whether something was changed
void build_timeline(App& app, ui::Ui& ui);
void build_status_line(App& app, ui::Ui& ui);
void build_shader_errors(App& app, ui::Ui& ui); // only while there are some
void build_dialogs(App& app, ui::Ui& ui);
// The brush's outline on the ground, over the picture: sharp at any render scale, and moving it needs no new picture.
void draw_ring(App& app, ui::Ui& ui, const ui::Rect& viewport);

[[nodiscard]] ui::Icon tool_icon(Tool tool);
// What the colours of a debug view mean, over the foot of the picture.
void draw_legend(App& app, ui::Ui& ui, const ui::Rect& viewport);

} // namespace loam::window
