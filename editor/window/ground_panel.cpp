// How the layers are laid over the ground: distortion, tile hiding.
#include <algorithm>

#include "editor/window/panels.h"

namespace loam::window {

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
    if (ground != app.session.document().settings().ground) app.change_settings(settings);
}

} // namespace loam::window
