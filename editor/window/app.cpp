#include "editor/window/app.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

#include "editor/stamp_import.h"

namespace loam::window {

namespace {

constexpr int kHistoryLength = 400; // commands looked at
constexpr int kMostSteps = 60;      // shown

struct Titles {
    std::string operator()(const SculptCommand& c) const {
        constexpr std::string_view names[] = {"Raise", "Lower", "Smooth", "Flatten"};
        return std::string(names[size_t(c.mode)]);
    }
    std::string operator()(const PaintCommand& c) const {
        return c.layer ? fmt::format("Paint {}", *c.layer) : std::string("Tint");
    }
    std::string operator()(const FillCommand& c) const {
        const std::string with = c.layer.value_or("tint");
        return c.replace ? fmt::format("Replace {} by {}", *c.replace, with) : fmt::format("Fill {}", with);
    }
    std::string operator()(const CraterCommand& c) const { return fmt::format("Crater {:.1f} m", c.crater.radius_m); }
    std::string operator()(const FootprintsCommand&) const { return "Footprints"; }
    std::string operator()(const AddOperatorCommand& c) const { return std::string(kind_title(c.shape)); }
    std::string operator()(const EditOperatorCommand& c) const { return fmt::format("Edit {}", kind_title(c.shape)); }
    std::string operator()(const ReorderCommand&) const { return "Reorder object"; }
    std::string operator()(const SetOperatorCommand& c) const {
        return c.enabled ? "Show object" : "Hide object";
    }
    std::string operator()(const RemoveOperatorCommand&) const { return "Remove object"; }
    std::string operator()(const TransitionCommand& c) const {
        return fmt::format("{} {}", c.remove ? "Remove" : "Transition", c.name);
    }
    std::string operator()(const TimeCommand& c) const { return fmt::format("Time {:.1f} s", c.time_s); }
    std::string operator()(const FunctionCommand& c) const { return "Function " + c.name; }
    std::string operator()(const UndoCommand&) const { return "Undo"; }
    std::string operator()(const RedoCommand&) const { return "Redo"; }
};

} // namespace

std::string_view title_of(EventKind kind) {
    constexpr std::string_view names[] = {"Impact",     "Line of craters", "Barrage",
                                          "Crash site", "Landslide",       "Flood"};
    static_assert(std::size(names) == kEventKinds);
    return names[size_t(kind)];
}

std::string_view kind_title(const OperatorShape& shape) {
    constexpr std::string_view names[] = {"Crater", "Footprint", "Decal", "Road",  "Volume decal",
                                          "Stamp",  "Cutout",    "Slide", "Flood", "Event"};
    static_assert(std::size(names) == std::variant_size_v<OperatorShape>);
    if (const auto* event = std::get_if<Event>(&shape)) return title_of(event->kind);
    return names[shape.index()];
}

std::string command_title(std::string_view json) {
    const auto command = parse_command(json);
    return command ? std::visit(Titles{}, command->body) : std::string("Command");
}

App::App(Session& opened, const ui::Theme&)
    : session(opened),
      tools({.next_group = [this] { return session.document().next_group(); },
             .layer_at = [this](double x, double y) { return layer_name_at(x, y); }}),
      camera(opened.default_camera(), [this](double x, double y) { return height_at(x, y); }) {
    read_layer_names();
    if (!layer_names.empty()) tools.settings.layer = layer_names.front();
    // Sizes that suit the map: a brush that is seen from where the camera starts.
    const WorldRect bounds = session.document().bounds();
    const double side = std::max(bounds.width(), bounds.height());
    for (Brush& brush : tools.settings.brushes) brush.radius_m = std::clamp(side / 40, 2.0, 60.0);
    tools.settings.stamp.height_m = std::clamp(side / 80, 1.0, 30.0);
    tools.settings.brushes[size_t(Tool::crater)].radius_m = std::clamp(side / 60, 2.0, 30.0);
    bind_shortcuts();
    say("Ready");
}

double App::height_at(double x_m, double y_m) {
    const auto height = session.height_m(x_m, y_m);
    return height ? *height : 0.0;
}

std::string App::layer_name_at(double x_m, double y_m) {
    if (!session.document().bounds().contains(x_m, y_m)) return {};
    const auto texel = session.layer_at(x_m, y_m);
    if (!texel || texel->layer >= layer_names.size()) return {};
    return layer_names[texel->layer];
}

void App::fail(std::string message) {
    if (!message.empty()) message[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(message[0])));
    message_ = message;
    errors_.push_back(std::move(message));
}

// --- edits ---

bool App::apply(const Command& command) {
    const auto dirt = session.apply(command);
    if (!dirt) {
        fail(dirt.message());
        tools.cancel();
        return false;
    }
    scene_changed_ = true;
    if (dirt->layers) {
        settings_changed_ = true;
        read_layer_names();
        if (layer() < 0) set_layer(0);  // undone under the brush
    }
    if (on_command) on_command(command);
    return true;
}

void App::start_fill() {
    if (filling() || tools.stroking()) return;
    const ToolSettings& s = tools.settings;
    FillCommand command{.rect = {},
                        .layer = {},
                        .tint = {},
                        .replace = {},
                        .strength = tools.brush().strength,
                        .mask = s.mask,
                        .seed = uint32_t(session.document().next_group() * 977),
                        .transitions = s.transitions};
    if (!s.layer.empty()) command.layer = s.layer;
    if (s.use_tint) command.tint = glm::dvec3(s.tint);
    if (replaced_layer > 0 && size_t(replaced_layer) <= layer_names.size())
        command.replace = layer_names[size_t(replaced_layer - 1)];
    if (const Status checked = check_command({command}); !checked) return fail(checked.message());
    fill_.emplace(session, std::move(command));
}

void App::advance_fill() {
    if (!fill_) return;
    const auto start = std::chrono::steady_clock::now();
    constexpr std::chrono::milliseconds kSlice(25);
    while (!fill_->done() && std::chrono::steady_clock::now() - start < kSlice)
        if (const auto dirt = fill_->step(); !dirt)
            fail(dirt.message());
        else if (on_command)
            on_command(fill_->last());
    scene_changed_ = true;
    if (!fill_->done()) return;
    fill_.reset();
    say("Filled");
}

void App::cancel_fill() {
    if (!fill_) return;
    if (const auto dirt = fill_->cancel(); !dirt)
        fail(dirt.message());
    else if (on_command)
        on_command(fill_->last());
    fill_.reset();
    scene_changed_ = true;
    say("The fill was taken back");
}

void App::undo_step() {
    if (filling() || tools.stroking()) return;
    if (!session.document().can_undo()) return say("Nothing to undo");
    if (apply({.body = UndoCommand{}})) say("Undone");
}

void App::redo_step() {
    if (filling() || tools.stroking()) return;
    if (!session.document().can_redo()) return say("Nothing to redo");
    if (apply({.body = RedoCommand{}})) say("Redone");
}

void App::go_to(uint64_t sequence) {
    // Bounded: every step moves at least one entry of the list.
    for (int i = 0; i < kHistoryLength; ++i) {
        uint64_t newest = 0;
        for (const HistoryStep& step : history())
            if (step.applied) newest = std::max(newest, step.last_sequence);
        if (newest == sequence) return;
        const bool back = newest > sequence;
        if (back ? !session.document().can_undo() : !session.document().can_redo()) return;
        if (!apply(back ? Command{.body = UndoCommand{}} : Command{.body = RedoCommand{}})) return;
    }
}

const std::vector<HistoryStep>& App::history() {
    if (history_revision_ == session.document().revision()) return history_;
    history_revision_ = session.document().revision();
    history_.clear();
    auto entries = session.document().history(kHistoryLength);
    if (!entries) return history_;
    std::sort(entries->begin(), entries->end(), [](const auto& a, const auto& b) { return a.sequence < b.sequence; });
    uint64_t group = 0;
    for (const Document::HistoryEntry& entry : *entries) {
        if (history_.empty() || entry.group == 0 || entry.group != group)
            history_.push_back({.title = command_title(entry.json)});
        group = entry.group;
        HistoryStep& step = history_.back();
        step.last_sequence = entry.sequence;
        step.applied = entry.applied;
        ++step.command_count;
    }
    if (history_.size() > kMostSteps) history_.erase(history_.begin(), history_.end() - kMostSteps);
    return history_;
}

void App::change_settings(const ProjectSettings& settings) {
    if (const Status status = session.document().change_settings(settings); !status) return fail(status.message());
    settings_changed_ = scene_changed_ = true;
    read_layer_names();
}

void App::read_layer_names() {
    layer_names.clear();
    for (const LayerEntry& layer : session.document().settings().layers) layer_names.push_back(layer.name);
}

void App::set_tool(Tool tool) {
    if (tools.stroking()) return;
    tools.tool = tool;
    cursor_revision_ = ~uint64_t{0};  // not every tool sees holes
    if (tool == Tool::event) show_timeline = true;
    // Others may have added some since.
    if (tool == Tool::stamp) stamp_names = session.document().stamps();
    say(tool == Tool::stamp && stamp_names.empty()
            ? "Stamp tool: there is no stamp yet, Ctrl+T adds a picture"
            : fmt::format("{} tool", tool_title(tool)));
}

int App::layer() const {
    const auto at = std::find(layer_names.begin(), layer_names.end(), tools.settings.layer);
    return at == layer_names.end() ? -1 : static_cast<int>(at - layer_names.begin());
}

void App::set_layer(int index) {
    if (index >= 0 && size_t(index) < layer_names.size()) tools.settings.layer = layer_names[size_t(index)];
}

void App::change_quality(Quality quality, PageFormat format) {
    view.quality = quality;
    view.page_format = format;
    quality_changed_ = scene_changed_ = true;
}

void App::start_import(ImportJob::Steps steps) {
    if (import_)
        return fail(fmt::format("wait for the import that is running, or cancel it: {}", import_->title()));
    say(steps.title);
    import_ = std::make_unique<ImportJob>(std::move(steps));
}

void App::import_layer(const AddLayerRequest& request) {
    auto planned = LayerImport::plan(session.document(), request);
    if (!planned) return fail(planned.message());
    const std::shared_ptr<LayerImport> import(std::move(*planned));
    const auto adopt = [this, import]() -> Status {
        const auto added = import->adopt(session.document());
        if (!added) return added.error();
        settings_changed_ = true;
        read_layer_names();
        set_layer(added->index);
        if (!tools.stroking()) set_tool(Tool::paint);
        say(fmt::format("Layer {} added, {} texels", added->entry.name,
                        added->report.at("size_texels").get<int>()));
        for (const PackJson& warning : added->report.at("warnings"))
            errors_.push_back(warning.get<std::string>());
        return {};
    };
    start_import({fmt::format("Adding layer {}", import->name()),
                  [import](const Progress& progress) { return import->make(progress); }, adopt});
}

void App::import_imagery(const std::filesystem::path& file) {
    auto planned = ImageryImport::plan(session.document(), {.file = file, .strength = {}, .distance_m = {}});
    if (!planned) return fail(planned.message());
    const std::shared_ptr<ImageryImport> import(std::move(*planned));
    const auto adopt = [this, import]() -> Status {
        const auto added = import->adopt(session.document());
        if (!added) return added.error();
        settings_changed_ = true;
        say(fmt::format("Imagery added, texels of {} m; it shows from {:.0f} m on", added->shape.spacing_m,
                        added->settings.distance_m));
        for (const std::string& note : added->notes) errors_.push_back(note);
        return {};
    };
    start_import(
        {"Adding imagery", [import](const Progress& progress) { return import->make(progress); }, adopt});
}

void App::import_stamp(const std::filesystem::path& file, const std::string& name) {
    const auto added = std::make_shared<AddedStamp>();
    const auto make = [added, folder = session.document().folder(), file,
                       name](const Progress& progress) -> Status {
        auto made = loam::add_stamp(folder, file, name, progress);
        if (!made) return made.error();
        *added = std::move(*made);
        return {};
    };
    const auto adopt = [this, added]() -> Status {
        tools.settings.stamp.image = added->name;
        if (!tools.stroking()) set_tool(Tool::stamp);
        stamp_names = session.document().stamps();
        say(fmt::format("Stamp {} added, {} x {} texels", added->name, added->width, added->height));
        for (const std::string& note : added->notes) errors_.push_back(note);
        return {};
    };
    start_import({fmt::format("Adding stamp {}", name.empty() ? file.stem().string() : name), make, adopt});
}

void App::cancel_import() {
    if (import_) import_->cancel();
}

void App::advance_import() {
    if (!import_ || !import_->done()) return;
    const std::unique_ptr<ImportJob> job = std::move(import_);
    const Status finished = job->finish();
    if (finished)
        scene_changed();
    else if (finished.message() == kCancelled)
        say("The import was cancelled, nothing was added");
    else
        fail(finished.message());
}

void App::resize_brush(double factor) {
    if (tools.tool == Tool::footprints) {
        tools.settings.gait.length_m = std::clamp(tools.settings.gait.length_m * factor, 0.05, 5.0);
        return;
    }
    Brush& brush = tools.brush();
    brush.radius_m = std::clamp(brush.radius_m * factor, ToolController::kSmallestRadius_m,
                                ToolController::kLargestRadius_m);
    say(fmt::format("Radius {:.2f} m", brush.radius_m));
}

void App::strengthen_brush(double factor) {
    Brush& brush = tools.brush();
    brush.strength = std::clamp(brush.strength * factor, 0.01, 1.0);
    say(fmt::format("Strength {:.0f} %", brush.strength * 100));
}

} // namespace loam::window
