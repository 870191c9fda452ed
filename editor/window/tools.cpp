#include "editor/window/tools.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace loam::window {

namespace {

constexpr double kDragBegins_px = 5; // a crater's click may tremble so much

constexpr std::array<std::string_view, kToolCount> kNames = {"raise", "lower",  "smooth",    "flatten",
                                                             "paint", "crater", "footprints"};
constexpr std::array<std::string_view, kToolCount> kTitles = {"Raise", "Lower",  "Smooth",    "Flatten",
                                                              "Paint", "Crater", "Footprints"};

SculptMode mode_of(Tool tool) {
    switch (tool) {
        case Tool::lower: return SculptMode::lower;
        case Tool::smooth: return SculptMode::smooth;
        case Tool::flatten: return SculptMode::flatten;
        default: return SculptMode::raise;
    }
}

bool is_sculpting(Tool tool) {
    return tool == Tool::raise || tool == Tool::lower || tool == Tool::smooth || tool == Tool::flatten;
}

} // namespace

std::string_view tool_name(Tool tool) {
    return kNames[size_t(tool)];
}

std::string_view tool_title(Tool tool) {
    return kTitles[size_t(tool)];
}

ToolController::ToolController(ToolQueries queries) : queries_(std::move(queries)) {
    settings.brushes[size_t(Tool::flatten)].hardness = 0.6;
    settings.brushes[size_t(Tool::paint)] = {.radius_m = 6, .strength = 1, .hardness = 0.7};
    settings.brushes[size_t(Tool::crater)].radius_m = 8;
}

void ToolController::cancel() {
    stroking_ = picking_ = false;
    spacer_.end();
    gait_.end();
}

void ToolController::begin(const ToolInput& input) {
    picking_ = false;
    stroke_tool_ = tool;
    if (input.ctrl) {
        if (tool == Tool::raise) stroke_tool_ = Tool::lower;
        if (tool == Tool::lower) stroke_tool_ = Tool::raise;
        picking_ = tool == Tool::flatten || tool == Tool::paint;
    }
    if (input.shift && is_sculpting(tool)) stroke_tool_ = Tool::smooth;
    stroking_ = true;
    group_ = picking_ ? 0 : queries_.next_group();
    command_count_ = 0;
    resting_s_ = 0;
    const glm::dvec2 at(*input.ground);
    center_m_ = at;
    target_m_ = settings.flatten_fixed ? settings.flatten_target_m : input.ground->z;
    if (picking_ && tool == Tool::flatten) {
        settings.flatten_target_m = input.ground->z;
        settings.flatten_fixed = true;
    }
    if (picking_ && tool == Tool::paint) settings.layer = queries_.layer_at(at.x, at.y);
    if (tool == Tool::footprints) gait_.begin(at);
    else spacer_.begin(at);
}

std::vector<glm::dvec2> ToolController::dabs(const ToolInput& input, bool also_resting) {
    std::vector<glm::dvec2> at;
    if (!input.ground) {
        spacer_.end(); // over the sky: what comes after is not joined to what was before
        return at;
    }
    const glm::dvec2 here(*input.ground);
    if (!spacer_.begun()) spacer_.begin(here);
    spacer_.extend(here, std::max(brush().radius_m * kSpacingShare, 0.02), at);
    // Where the button is held still the tool keeps working, so many times a second whatever the frame rate.
    resting_s_ = at.empty() ? resting_s_ + input.dt_s : 0;
    while (also_resting && resting_s_ >= 1 / kHeldDabsPerSecond) {
        resting_s_ -= 1 / kHeldDabsPerSecond;
        if (at.size() < 8) at.push_back(here);
    }
    return at;
}

std::optional<Command> ToolController::sculpt(const ToolInput& input) {
    SculptCommand command{.mode = mode_of(stroke_tool_), .dabs = dabs(input, true)};
    if (command.dabs.empty()) return {};
    command.radius_m = brush().radius_m;
    command.hardness = brush().hardness;
    const bool moves = command.mode == SculptMode::raise || command.mode == SculptMode::lower;
    // Smoothing and flattening by a part a dab: several dabs overlap at every place of a stroke.
    command.strength = moves ? dab_height_m(brush()) : 0.6 * brush().strength;
    command.target_m = command.mode == SculptMode::flatten ? target_m_ : 0.0;
    return Command{.body = std::move(command), .group = group_};
}

std::optional<Command> ToolController::paint(const ToolInput& input) {
    PaintCommand command{.dabs = dabs(input, brush().strength < 1)};
    if (command.dabs.empty()) return {};
    if (!settings.layer.empty()) command.layer = settings.layer;
    if (settings.use_tint) command.tint = glm::dvec3(settings.tint);
    if (!command.layer && !command.tint) return {};
    command.radius_m = brush().radius_m;
    command.strength = brush().strength;
    command.hardness = brush().hardness;
    command.min_slope_rad = settings.min_slope_rad;
    command.max_slope_rad = settings.max_slope_rad;
    command.transitions = settings.transitions;
    command.seed = uint32_t(group_ * 977) + command_count_; // other texels at each pass, so that strength builds up
    return Command{.body = std::move(command), .group = group_};
}

double ToolController::crater_radius_m(const ToolInput& input) const {
    if (!stroking_ || input.moved_px < kDragBegins_px || !input.ground) return brush().radius_m;
    return std::clamp(glm::length(glm::dvec2(*input.ground) - center_m_), kSmallestRadius_m, kLargestRadius_m);
}

std::optional<Command> ToolController::crater(const ToolInput& input) {
    if (!input.released) return {};
    const double radius = crater_radius_m(input);
    settings.brushes[size_t(Tool::crater)].radius_m = radius;
    return Command{.body = CraterCommand{{.x_m = center_m_.x,
                                          .y_m = center_m_.y,
                                          .radius_m = radius,
                                          .depth_m = radius * settings.crater_depth_share,
                                          .seed = settings.seed++,
                                          .heat = settings.crater_heat}},
                   .group = group_};
}

std::optional<Command> ToolController::footprints(const ToolInput& input) {
    FootprintsCommand command;
    if (input.ground) gait_.extend(glm::dvec2(*input.ground), settings.gait, settings.seed, command.prints);
    if (input.released && gait_.print_count() == 0)
        command.prints.push_back(gait_.single(settings.gait, input.camera_yaw_rad, settings.seed));
    if (input.released) ++settings.seed;
    if (command.prints.empty()) return {};
    return Command{.body = std::move(command), .group = group_};
}

std::vector<Command> ToolController::update(const ToolInput& input) {
    if (input.pressed && input.ground) begin(input);
    if (!stroking_) return {};
    if (!input.held && !input.released) { // the capture was lost
        cancel();
        return {};
    }
    std::optional<Command> command;
    if (!picking_) {
        if (tool == Tool::crater) command = crater(input);
        else if (tool == Tool::footprints) command = footprints(input);
        else if (tool == Tool::paint) command = paint(input);
        else command = sculpt(input);
    }
    if (input.released) cancel();
    if (!command) return {};
    ++command_count_;
    return {*std::move(command)};
}

std::optional<ToolController::Ring> ToolController::ring(const ToolInput& input) const {
    if (!input.ground) return {};
    const glm::dvec2 at(*input.ground);
    if (tool == Tool::crater) return Ring{stroking_ ? center_m_ : at, crater_radius_m(input), 0};
    if (tool == Tool::footprints) return Ring{at, settings.gait.length_m * 0.5, 0};
    return Ring{at, brush().radius_m, brush().hardness};
}

} // namespace loam::window
