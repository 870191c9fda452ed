// Functions of decals: which one a decal is made by, its parameters, and its text, which is compiled while it
// is written; what is on the ground stays until the new text compiles.
#include <algorithm>
#include <charconv>

#include "editor/window/panels.h"
#include "runtime/document/function_library.h"

namespace loam::window {

namespace {

constexpr double kPause_s = 0.35;  // without a key, after which a text is compiled
constexpr const char* kNewDialog = "New function";
constexpr const char* kTemplate =
    "// What it is, in one line\n"
    "//@ size 0.5 0.05 5 Size of its spots, metres\n"
    "\n"
    "void decal(Place at, inout Surface s) {\n"
    "    float spots = ramp(-0.1, 0.1, fbm(at.p / size, at.seed, 4));\n"
    "    s.colour *= srgb(0.5, 0.4, 0.3);\n"
    "    s.cover = spots;\n"
    "}\n";

// "moss_red" reads "Moss red".
std::string title_of_function(const std::string& name) {
    std::string title = name;
    std::replace(title.begin(), title.end(), '_', ' ');
    if (!title.empty()) title[0] = char(std::toupper(static_cast<unsigned char>(title[0])));
    return title;
}

std::vector<std::string> titles_of(const std::vector<std::string>& names) {
    std::vector<std::string> titles;
    for (const std::string& name : names) titles.push_back(title_of_function(name));
    return titles;
}

// The marks of a message of lines "decals/NAME.glsl:LINE: what".
std::vector<ui::TextAreaMark> marks_of(const std::string& message) {
    std::vector<ui::TextAreaMark> marks;
    for (size_t at = 0; at < message.size();) {
        const size_t end = std::min(message.find('\n', at), message.size());
        const std::string_view line = std::string_view(message).substr(at, end - at);
        at = end + 1;
        const size_t colon = line.find(':'), says = line.find(": ", colon + 1);
        if (colon == std::string_view::npos || says == std::string_view::npos) continue;
        ui::TextAreaMark mark;
        std::from_chars(line.data() + colon + 1, line.data() + says, mark.line);
        mark.says = line.substr(says + 2);
        marks.push_back(mark);
    }
    return marks;
}

}  // namespace

bool function_properties(App& app, ui::Ui& ui, std::string& function,
                         std::map<std::string, double>& parameters) {
    const std::vector<std::string>& names = app.function_names();
    std::vector<std::string> titles = titles_of(names);
    titles.insert(titles.begin(), "None");
    const std::vector<std::string_view> choices(titles.begin(), titles.end());
    const auto found = std::find(names.begin(), names.end(), function);
    int which = found == names.end() ? 0 : int(found - names.begin()) + 1;
    bool changed = false;
    if (ui::combo(ui, "Function", which, choices)) {
        function = which == 0 ? std::string() : names[size_t(which - 1)];
        parameters.clear();
        changed = true;
    }
    if (function.empty()) return changed;
    const auto shown = app.session.document().functions().find(function);
    if (!shown) {
        ui::paragraph(ui, shown.message(), ui::Tone::error);
    } else {
        for (const FunctionParameter& p : (*shown)->parameters) {
            const auto set = parameters.find(p.name);
            double value = set == parameters.end() ? p.value : std::clamp(set->second, p.min, p.max);
            const double range = p.max - p.min;
            const int decimals = range >= 1000 ? 0 : range >= 100 ? 1 : range >= 0.5 ? 2 : 3;
            if (!ui::slider(ui, title_of_function(p.name), value,
                            {.min = p.min, .max = p.max, .decimals = decimals, .tooltip = p.says}))
                continue;
            parameters[p.name] = value;
            changed = true;
        }
        // What the text does not have any more, or not so far, would be refused.
        if (changed) {
            std::map<std::string, double> kept;
            for (const FunctionParameter& p : (*shown)->parameters)
                if (const auto set = parameters.find(p.name); set != parameters.end())
                    kept[p.name] = std::clamp(set->second, p.min, p.max);
            parameters = std::move(kept);
        }
    }
    if (ui::button(ui, "Edit function…")) app.edit_function(function);
    return changed;
}

// Under the outliner's list: what the selected decal, road or volume is made by.
void selected_decal_properties(App& app, ui::Ui& ui) {
    const Operator* op = app.selected_operator();
    const DecalMaterial* material = op ? material_of(op->shape) : nullptr;
    if (!material) return;
    ui::separator(ui);
    ui.push_id(fmt::format("decal{}", op->id));
    OperatorShape shape = op->shape;
    DecalMaterial changed = *material;
    double percent = changed.opacity * 100;
    bool any = false;
    if (ui::slider(ui, "Opacity", percent, {.min = 0, .max = 100, .decimals = 0, .unit = "%"})) {
        changed.opacity = percent / 100;
        any = true;
    }
    int seed = int(changed.seed % 10000);
    if (ui::slider(ui, "Seed", seed, {.min = 0, .max = 9999})) {
        changed.seed = uint32_t(seed);
        any = true;
    }
    any |= function_properties(app, ui, changed.function, changed.parameters);
    auto* decal = std::get_if<TerrainDecal>(&shape);
    if (decal && ui::slider(ui, "Displacement", decal->displacement_m, kDisplacement)) any = true;
    // The whole road leans; points that lean otherwise keep their difference.
    if (auto* spline = std::get_if<SplineDecal>(&shape); spline && spline->carve > 0) {
        double sum = 0;
        for (const SplinePoint& point : spline->points) sum += point.roll_rad;
        const double mean_rad = sum / double(spline->points.size());
        constexpr double kDegrees = 180 / M_PI;
        double degrees = mean_rad * kDegrees;
        if (ui::slider(ui, "Roll", degrees,
                       {.min = -30,
                        .max = 30,
                        .decimals = 1,
                        .unit = "°",
                        .tooltip = "Of the carved profile; positive lowers the right side"})) {
            for (SplinePoint& point : spline->points)
                point.roll_rad = std::clamp(point.roll_rad + degrees / kDegrees - mean_rad, -1.2, 1.2);
            any = true;
        }
    }
    if (material->function.empty() && !changed.function.empty()) {  // its own colours, not those of a layer
        changed.layer.clear();
        changed.colour = {1, 1, 1};
    }
    ui.pop_id();
    if (any)
        std::visit(
            [&](auto& kind) {
                if constexpr (requires { kind.material.channels; }) kind.material = changed;
            },
            shape);
    app.edit_selected(any ? std::optional(shape) : std::nullopt, ui);
}

// One step of the history a drag.
void App::edit_selected(const std::optional<OperatorShape>& shape, ui::Ui& ui) {
    if (shape) {
        if (object_group == 0) object_group = session.document().next_group();
        apply({.body = EditOperatorCommand{.id = selected_object, .shape = *shape, .life = {}},
               .group = object_group});
    } else if (!ui.button_down(ui::MouseButton::left)) {
        object_group = 0;
    }
}

const std::vector<std::string>& App::function_names() {
    if (function_names_revision_ != session.document().revision()) {
        function_names_revision_ = session.document().revision();
        function_names_ = session.document().functions().names();
    }
    return function_names_;
}

void App::edit_function(const std::string& name) {
    if (functions.name != name) {
        leave_function();
        const auto text = session.document().functions().text(name);
        functions = {
            .name = name, .text = text ? *text : std::string(), .saved = text ? *text : std::string()};
        functions.tried = functions.saved;
        if (!text) functions.error = text.message();
        if (auto draft = session.document().functions().draft(name)) functions.text = std::move(*draft);
    }
    show_functions = true;
}

void App::leave_function() {
    if (!functions.name.empty() && functions.text != functions.saved && functions.text != functions.tried)
        try_function();
}

void App::try_function() {
    functions.tried = functions.text;
    const auto dirt = session.apply({.body = FunctionCommand{functions.name, functions.text}});
    functions.error = dirt ? std::string() : dirt.message();
    if (!dirt) {
        const Status kept = session.document().functions().keep_draft(functions.name, functions.text);
        if (!kept) fail(kept.message());
        return;
    }
    functions.saved = functions.text;
    scene_changed_ = true;
    function_names_revision_ = ~uint64_t{0};
    say(fmt::format("{} compiles", title_of_function(functions.name)));
}

bool App::poll_functions() {
    const Dirt dirt = session.poll_functions();
    const bool shown = !dirt.empty();
    if (shown) {
        function_names_revision_ = ~uint64_t{0};
        scene_changed_ = true;
    }
    // What another program saved is shown here too, unless something else is being written here.
    if (functions.name.empty() || functions.text != functions.saved) return shown;
    const auto text = session.document().functions().text(functions.name);
    if (!text || *text == functions.saved) return shown;
    functions.text = functions.saved = functions.tried = *text;
    const auto errors = session.document().functions().errors();
    const auto wrong = errors.find(functions.name);
    functions.error = wrong == errors.end() ? std::string() : wrong->second;
    return true;
}

void build_function_panel(App& app, ui::Ui& ui) {
    if (!app.show_functions) return;
    if (app.functions.name.empty()) {
        if (app.function_names().empty()) return;
        app.edit_function(app.function_names().front());
    }
    auto panel = ui::panel(ui, "functions",
                           {.edge = ui::Edge::bottom,
                            .size = 300,
                            .min_size = 120,
                            .max_size = 700,
                            .resizable = true,
                            .padding = 6});
    FunctionText& f = app.functions;
    ui::Rect area = ui.allocate_rest();
    {
        auto top = ui.row_in(ui::cut(area, ui::Edge::top, ui.px(28)), 8);
        const std::vector<std::string>& names = app.function_names();
        const std::vector<std::string> titles = titles_of(names);
        const std::vector<std::string_view> choices(titles.begin(), titles.end());
        int which = int(std::find(names.begin(), names.end(), f.name) - names.begin());
        auto row = ui.row({ui::fixed(240), ui::fixed(70), ui::flex(), ui::fixed(28)}, 26);
        if (ui::combo(ui, "Text of", which, choices)) app.edit_function(names[size_t(which)]);
        if (ui::button(ui, "New…")) {
            app.new_function_name.clear();
            ui::open_dialog(ui, kNewDialog);
        }
        const auto shown = app.session.document().functions().shown(f.name);
        const auto failed = app.session.document().functions().failed_texels();
        if (!f.error.empty())
            ui::label(ui, f.error.substr(0, f.error.find('\n')), ui::Tone::error);
        else if (const auto bad = failed.find(f.name); bad != failed.end())
            ui::label(ui,
                      fmt::format("It gave no number (NaN or infinite) at {} texels, which stay as they are",
                                  bad->second),
                      ui::Tone::warning);
        else
            ui::label(ui,
                      f.text != f.saved ? "…"
                      : shown           ? fmt::format("Compiles, at most {} steps a texel", shown->steps)
                                        : "No decal shows it yet",
                      ui::Tone::dim);
        if (ui::icon_button(ui, "close functions", {.icon = ui::Icon::cross, .tooltip = "Close", .size = 24}))
            app.show_functions = false;
    }
    ui::cut(area, ui::Edge::top, ui.px(4));
    {
        auto column = ui.column_in(area);
        const std::vector<ui::TextAreaMark> marks = marks_of(f.error);
        ui.push_id(f.name);
        if (ui::text_area(ui, "text", f.text, {.marks = marks, .max_bytes = kLargestFunction_bytes}))
            f.changed_s = ui.time_s();
        ui.pop_id();
    }
    if (f.text == f.tried || f.text == f.saved) {
        if (f.text == f.saved && f.tried != f.saved) {  // taken back
            f.error.clear();
            f.tried = f.saved;
            app.session.document().functions().drop_draft(f.name);
        }
        return;
    }
    if (ui.time_s() >= f.changed_s + kPause_s) {
        app.try_function();
        ui.request_redraw();
    } else {
        ui.wake_at(f.changed_s + kPause_s);
    }
}

void new_function_dialog(App& app, ui::Ui& ui) {
    auto dialog = ui::dialog(ui, kNewDialog, 420);
    if (!dialog) return;
    ui::text_field(ui, "Name", app.new_function_name, {.placeholder = "letters, digits, _ and -"});
    ui.space(8);
    if (ui::dialog_buttons(ui, {"Cancel", "Make"}) != 1) return;
    const std::string name = app.new_function_name;
    const auto& names = app.function_names();
    if (std::find(names.begin(), names.end(), name) != names.end()) return app.edit_function(name);
    if (app.apply({.body = FunctionCommand{name, kTemplate}})) app.edit_function(name);
}

}  // namespace loam::window
