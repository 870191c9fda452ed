// Actions by name and the keys that run them; menus and tooltips show the same keys.
#include <filesystem>

#include "editor/window/panels.h"

namespace loam::window {

namespace {

using ui::Key;
using ui::Mods;

constexpr double kSizeStep = 1.15, kStrengthStep = 1.2;

struct Bound {
    std::string_view action;
    Key key;
    Mods mods;
};

constexpr Mods kCtrl{.ctrl = true}, kShift{.shift = true}, kCtrlShift{.ctrl = true, .shift = true};

constexpr Bound kBound[] = {
    {"raise", Key::digit_1, {}},
    {"lower", Key::digit_2, {}},
    {"smooth", Key::digit_3, {}},
    {"flatten", Key::digit_4, {}},
    {"paint", Key::digit_5, {}},
    {"crater", Key::digit_6, {}},
    {"footprints", Key::digit_7, {}},
    {"decal", Key::digit_8, {}},
    {"road", Key::digit_9, {}},
    {"stamp", Key::digit_0, {}},
    {"cutout", Key::c, {}},
    {"event", Key::e, {}},
    {"play", Key::space, {}},
    {"timeline", Key::t, {}},
    {"functions", Key::f4, {}},
    {"raise", Key::r, {}},
    {"lower", Key::l, {}},
    {"paint", Key::b, {}},
    {"smaller", Key::left_bracket, {}},
    {"larger", Key::right_bracket, {}},
    {"weaker", Key::left_bracket, kShift},
    {"stronger", Key::right_bracket, kShift},
    {"previous layer", Key::comma, {}},
    {"next layer", Key::period, {}},
    {"fill", Key::f, kCtrl},
    {"undo", Key::z, kCtrl},
    {"redo", Key::y, kCtrl},
    {"redo", Key::z, kCtrlShift},
    {"open", Key::o, kCtrl},
    {"save", Key::s, kCtrl},
    {"export", Key::e, kCtrl},
    {"add layer", Key::l, kCtrl},
    {"add stamp", Key::t, kCtrl},
    {"add imagery", Key::i, kCtrl},
    {"quit", Key::q, kCtrl},
    {"remove object", Key::del, {}},
    {"frame", Key::f, {}},
    {"home", Key::home, {}},
    {"shortcuts", Key::f1, {}},
    {"direct shading", Key::f3, {}},
    {"above ground", Key::g, {}},
};

} // namespace

void App::bind_shortcuts() {
    for (const Bound& b : kBound) shortcuts.bind(b.action, b.key, b.mods);
}

void App::run(std::string_view action, ui::Ui& ui) {
    for (int i = 0; i < kToolCount; ++i)
        if (action == tool_name(Tool(i))) return set_tool(Tool(i));
    if (action == "smaller") return resize_brush(1 / kSizeStep);
    if (action == "larger") return resize_brush(kSizeStep);
    if (action == "weaker") return strengthen_brush(1 / kStrengthStep);
    if (action == "stronger") return strengthen_brush(kStrengthStep);
    if (action == "previous layer" || action == "next layer") {
        const int count = static_cast<int>(layer_names.size());
        if (count > 0) set_layer((layer() + (action == "next layer" ? 1 : count - 1)) % count);
        return;
    }
    if (action == "play") return play(!playing);
    if (action == "timeline") {
        show_timeline = !show_timeline;
        return;
    }
    if (action == "functions") {
        show_functions = !show_functions;
        return;
    }
    if (action == "undo") return undo_step();
    if (action == "redo") return redo_step();
    if (action == "save") {
        // Every command is a committed transaction already.
        say("All changes are saved");
        ui.toast("All changes are saved: every edit is written as it is made.", ui.theme.success, 3);
        return;
    }
    if (action == "open") {
        path_text = session.document().folder().parent_path().string();
        return ui::open_dialog(ui, "Open project");
    }
    if (action == "record") {
        path_text = (std::filesystem::current_path() / "session.jsonl").string();
        return ui::open_dialog(ui, "Record script");
    }
    if (action == "export") {
        path_text = (std::filesystem::current_path() / (session.document().settings().name + ".png")).string();
        return ui::open_dialog(ui, "Export picture");
    }
    if (action == "add layer") {
        path_text = session.document().folder().parent_path().string();
        new_layer_name.clear();
        return ui::open_dialog(ui, "Add layer");
    }
    if (action == "add imagery") {
        path_text = session.document().folder().parent_path().string();
        return ui::open_dialog(ui, "Add imagery");
    }
    if (action == "add stamp") {
        path_text = session.document().folder().parent_path().string();
        new_stamp_name.clear();
        return ui::open_dialog(ui, "Add stamp");
    }
    if (action == "fill") {
        start_fill();
        if (filling()) ui::open_dialog(ui, kFillDialog);
        return;
    }
    if (action == "shortcuts") return ui::open_dialog(ui, "Keyboard and mouse");
    if (action == "quit") {
        quit = true;
        return;
    }
    if (action == "remove object") {
        if (!selected_row()) return say("Choose an object in the list of objects first");
        return remove_object(selected_object);
    }
    if (action == "frame") {
        if (!cursor_) return say("Point at the ground to frame a spot");
        camera.frame(*cursor_, std::max(tools.brush().radius_m, 1.0));
        return scene_changed();
    }
    if (action == "home") {
        camera.jump_to(session.default_camera());
        return scene_changed();
    }
    if (action == "direct shading") {
        view.shading = view.shading == Shading::direct ? Shading::virtual_texture : Shading::direct;
        say(view.shading == Shading::direct ? "Direct shading" : "Virtual texture");
        return scene_changed();
    }
    if (action == "above ground") {
        camera.keep_above_ground = !camera.keep_above_ground;
        say(camera.keep_above_ground ? "The camera stays above the ground" : "The camera may go below the ground");
    }
}

void App::handle_keys(const std::vector<ui::Event>& keys, ui::Ui& ui) {
    for (const ui::Event& event : keys) {
        if (!event.down) continue;
        if (event.key == Key::escape) {
            if (tools.stroking() || tools.drawing_road())
                tools.cancel();
            else
                selected_object = 0;
        }
        if (event.key == Key::enter && tools.tool == Tool::road)
            if (const auto command = tools.end_road()) apply(*command);
        const auto action = shortcuts.find(event.key, event.mods);
        if (!action) continue;
        // Letters steer while flying; the keys with Ctrl keep their meaning, but E and Q sit under the same fingers.
        if (flying()) continue;
        const bool repeats = *action == "smaller" || *action == "larger" || *action == "weaker" ||
                             *action == "stronger" || *action == "undo" || *action == "redo";
        if (event.repeat && !repeats) continue;
        run(std::string(*action), ui);
    }
}

} // namespace loam::window
