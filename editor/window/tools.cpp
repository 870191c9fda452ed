#include "editor/window/tools.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace loam::window {

namespace {

constexpr double kDragBegins_px = 5; // a click may tremble so much
constexpr double kCoarse_m = 0.25;   // a road's outline may miss it by so much

constexpr std::array<std::string_view, kToolCount> kNames = {"raise", "lower",  "smooth",     "flatten",
                                                             "paint", "crater", "footprints", "decal",
                                                             "road",  "stamp",  "cutout",     "event"};
constexpr std::array<std::string_view, kToolCount> kTitles = {"Raise", "Lower",  "Smooth",     "Flatten",
                                                              "Paint", "Crater", "Footprints", "Decal",
                                                              "Road",  "Stamp",  "Cutout",     "Event"};

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
    settings.brushes[size_t(Tool::decal)] = {.radius_m = 4, .strength = 1, .hardness = 0.7};
    settings.brushes[size_t(Tool::stamp)] = {.radius_m = 40, .strength = 1, .hardness = 0.8};
    settings.brushes[size_t(Tool::cutout)].radius_m = 5;
    for (int i = 0; i < kEventKinds; ++i) settings.events[size_t(i)] = default_event(EventKind(i));
    settings.brushes[size_t(Tool::road)] = {.radius_m = 3, .strength = 1, .hardness = 0.7};
}

void ToolController::cancel() {
    stroking_ = picking_ = false;
    spacer_.end();
    gait_.end();
    road_.clear();
}

void ToolController::begin(const ToolInput& input) {
    picking_ = false;
    stroke_tool_ = tool;
    if (input.ctrl) {
        if (tool == Tool::raise) stroke_tool_ = Tool::lower;
        if (tool == Tool::lower) stroke_tool_ = Tool::raise;
        picking_ = tool == Tool::flatten || tool == Tool::paint;
    }
    closing_ = tool == Tool::cutout && input.ctrl;
    if (input.shift && is_sculpting(tool)) stroke_tool_ = Tool::smooth;
    stroking_ = true;
    group_ = picking_ ? 0 : queries_.next_group();
    command_count_ = 0;
    resting_s_ = 0;
    const glm::dvec2 at(*input.ground);
    center_m_ = at;
    target_m_ = tool == Tool::flatten && settings.flatten_fixed ? settings.flatten_target_m : input.ground->z;
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
    command.mask = settings.mask;
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

DecalMaterial ToolController::material() const {
    DecalMaterial m;
    m.function = settings.function;
    if (m.function.empty())
        m.layer = settings.layer;
    else
        m.parameters = settings.parameters;
    if (settings.use_tint || (settings.layer.empty() && m.function.empty()))
        m.colour = glm::dvec3(settings.tint);
    m.opacity = brush().strength;
    m.edge = 1 - brush().hardness;
    m.seed = settings.seed;
    return m;
}

// Turned towards the cursor; a click leaves it pointing away from the camera.
double ToolController::heading_rad(const ToolInput& input) const {
    if (input.ground && input.moved_px >= kDragBegins_px)
        return std::atan2(input.ground->x - center_m_.x, input.ground->y - center_m_.y);
    return input.camera_yaw_rad;
}

TerrainDecal ToolController::decal_at(const ToolInput& input) const {
    TerrainDecal d;
    d.x_m = center_m_.x;
    d.y_m = center_m_.y;
    d.half_m = box_half_m();
    d.heading_rad = heading_rad(input);
    d.outline = settings.decal.ellipse ? DecalOutline::ellipse : DecalOutline::rectangle;
    d.displacement_m = settings.decal.displacement_m;
    d.material = material();
    d.material.rough = settings.decal.rough;
    return d;
}

std::optional<Command> ToolController::decal(const ToolInput& input) {
    if (!input.released) return {};
    Command command{.body = AddOperatorCommand{decal_at(input)}, .group = group_};
    ++settings.seed;
    return command;
}

// What is not added to the ground stands on it, where the button went down.
Stamp ToolController::stamp_at(const ToolInput& input) const {
    const StampDesc& desc = settings.stamp;
    Stamp s;
    s.image = desc.image;
    s.x_m = center_m_.x;
    s.y_m = center_m_.y;
    s.half_m = box_half_m();
    s.heading_rad = heading_rad(input);
    s.mode = desc.mode;
    s.height_m = desc.height_m;
    s.base_m = desc.mode == StampMode::add ? 0 : target_m_;
    s.strength = brush().strength;
    s.edge = 1 - brush().hardness;
    if (desc.lay_layer) s.layer = settings.layer;
    s.layer_from = desc.layer_from;
    s.colour = desc.colour;
    return s;
}

std::optional<Command> ToolController::stamp(const ToolInput& input) {
    if (!input.released || settings.stamp.image.empty()) return {};
    return Command{.body = AddOperatorCommand{stamp_at(input)}, .group = group_};
}

// A volume stands on the ground where the button went down, as deep as it is high.
std::optional<Command> ToolController::cutout(const ToolInput& input) {
    Cutout c{.form = settings.cutout.form};
    c.fill = closing_;
    if (c.form == CutoutForm::brush) {
        c.dabs = dabs(input, false);
        c.radius_m = brush().radius_m;
        if (c.dabs.empty()) return {};
    } else {
        if (!input.released) return {};
        c.center_m = glm::dvec3(center_m_, target_m_);
        c.half_m = glm::dvec3(box_half_m(), settings.cutout.depth_m);
        c.roll_rad = -heading_rad(input);  // headings are clockwise
    }
    return Command{.body = AddOperatorCommand{std::move(c)}, .group = group_};
}

// From where the button went down to the cursor, where the kind goes somewhere; after a click straight ahead.
Event ToolController::event_at(const ToolInput& input) const {
    Event e = settings.events[size_t(settings.event_kind)];
    e.x_m = center_m_.x;
    e.y_m = center_m_.y;
    e.start_s = input.time_s;
    e.seed = settings.seed;
    const bool dragged = input.ground && input.moved_px >= kDragBegins_px;
    const double heading = heading_rad(input);
    const glm::dvec2 ahead(std::sin(heading), std::cos(heading));
    switch (e.kind) {
        case EventKind::crater_line: {
            const double length_m = 3 * loam::crater_radius_m(e.energy_j) * e.count;
            e.to_m = dragged ? glm::dvec2(*input.ground) : center_m_ + ahead * length_m;
            break;
        }
        case EventKind::crash: {
            e.to_m = dragged ? glm::dvec2(*input.ground) : center_m_ + ahead * (12 * e.width_m);
            if (glm::length(*e.to_m - center_m_) < e.width_m) e.to_m = center_m_ + ahead * (1.01 * e.width_m);
            break;
        }
        case EventKind::landslide:
            if (dragged) e.to_m = glm::dvec2(*input.ground);
            break;
        case EventKind::flood:
            e.from_m = target_m_ - 0.5;
            e.level_m = target_m_ + settings.flood_rise_m;
            break;
        default:
            break;
    }
    return e;
}

std::optional<Command> ToolController::event(const ToolInput& input) {
    if (!input.released) return {};
    Command command{.body = AddOperatorCommand{event_at(input)}, .group = group_};
    ++settings.seed;
    return command;
}

glm::dvec2 ToolController::box_half_m() const {
    const double stretch = tool == Tool::stamp    ? settings.stamp.stretch
                           : tool == Tool::cutout ? settings.cutout.stretch
                                                  : settings.decal.stretch;
    return {brush().radius_m, brush().radius_m * stretch};
}

std::vector<SplinePoint> ToolController::road_points(const std::vector<glm::dvec3>& places) const {
    std::vector<SplinePoint> through;
    for (const glm::dvec3& at : places) through.push_back({at.x, at.y, at.z, 2 * brush().radius_m});
    return bezier_through(through);
}

std::optional<Command> ToolController::end_road() {
    SplineDecal road;
    road.points = road_points(road_);
    cancel();
    if (road.points.empty()) return {};
    road.carve = settings.road.carve ? 1 : 0;
    road.shoulder_m = settings.road.shoulder_m;
    road.fade_m = 2 * brush().radius_m;
    road.material = material();
    road.material.edge = settings.road.edge;
    Command command{.body = AddOperatorCommand{std::move(road)}, .group = 0};
    if (!check_command(command)) return {}; // both places are one
    ++settings.seed;
    return command;
}

std::optional<Command> ToolController::road(const ToolInput& input) {
    if (input.pressed && input.ground) {
        const double reach_m = std::max(brush().radius_m, 0.5);
        stroking_ = true;
        for (held_place_ = 0; held_place_ < road_.size(); ++held_place_)
            if (glm::length(glm::dvec2(road_[held_place_] - *input.ground)) < reach_m) break;
        held_last_ = !road_.empty() && held_place_ + 1 == road_.size();
        if (held_place_ == road_.size()) road_.push_back(*input.ground);
    }
    if (!stroking_) return {};
    if (input.ground && input.moved_px >= kDragBegins_px) road_[held_place_] = *input.ground;
    if (input.held && !input.released) return {};
    stroking_ = false;
    return input.released && held_last_ && input.moved_px < kDragBegins_px && road_.size() > 1 ? end_road()
                                                                                              : std::nullopt;
}

std::vector<Command> ToolController::update(const ToolInput& input) {
    if (tool == Tool::road) {
        auto command = road(input);
        return command ? std::vector<Command>{*std::move(command)} : std::vector<Command>{};
    }
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
        else if (tool == Tool::decal) command = decal(input);
        else if (tool == Tool::stamp)
            command = stamp(input);
        else if (tool == Tool::cutout)
            command = cutout(input);
        else if (tool == Tool::event)
            command = event(input);
        else if (tool == Tool::paint) command = paint(input);
        else command = sculpt(input);
    }
    if (input.released) cancel();
    if (!command) return {};
    ++command_count_;
    return {*std::move(command)};
}

std::vector<ToolController::Outline> ToolController::outlines(const ToolInput& input) const {
    if (places_box() && stroking_) {
        const double heading = heading_rad(input);
        const glm::dvec2 up(std::sin(heading), std::cos(heading)), right(up.y, -up.x);
        const glm::dvec2 half_m = box_half_m();
        Outline box{.places_m = {}, .closed = true};
        constexpr int kSteps = 8; // a side, so that it follows the ground
        const glm::dvec2 corners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
        for (int side = 0; side < 4; ++side)
            for (int i = 0; i < kSteps; ++i) {
                const glm::dvec2 at = glm::mix(corners[side], corners[side + 1], double(i) / kSteps) * half_m;
                box.places_m.push_back(center_m_ + right * at.x + up * at.y);
            }
        return {box};
    }
    if (tool == Tool::event && stroking_) {
        const Event e = event_at(input);
        if (e.to_m) return {Outline{.places_m = {center_m_, *e.to_m}, .closed = false}};
        return {};
    }
    if (tool != Tool::road || road_.empty()) return {};
    std::vector<glm::dvec3> places = road_;
    if (input.ground && !stroking_) places.push_back(*input.ground); // where a click would lead it
    const SplinePath path(road_points(places), kCoarse_m);
    Outline left, right;
    for (const SplineSegment& s : path.segments()) {
        const glm::dvec2 aside(s.direction.y, -s.direction.x);
        left.places_m.push_back(s.from_m - aside * s.half_from_m);
        right.places_m.push_back(s.from_m + aside * s.half_from_m);
        if (&s != &path.segments().back()) continue;
        const glm::dvec2 to = s.from_m + s.direction * s.length_m;
        left.places_m.push_back(to - aside * s.half_to_m);
        right.places_m.push_back(to + aside * s.half_to_m);
    }
    return {left, right};
}

std::optional<ToolController::Ring> ToolController::ring(const ToolInput& input) const {
    if (!input.ground) return {};
    const glm::dvec2 at(*input.ground);
    if (tool == Tool::crater) return Ring{stroking_ ? center_m_ : at, crater_radius_m(input), 0};
    if (tool == Tool::event) {
        const Event& e = settings.events[size_t(settings.event_kind)];
        const double radius_m = e.kind == EventKind::crash ? e.width_m / 2
                                : e.radius_m > 0           ? e.radius_m
                                                           : loam::crater_radius_m(e.energy_j);
        return Ring{stroking_ ? center_m_ : at, radius_m, 0};
    }
    if (tool == Tool::footprints) return Ring{at, settings.gait.length_m * 0.5, 0};
    if (places_box() && stroking_) return {};
    const bool even = tool == Tool::road || tool == Tool::cutout;
    return Ring{at, brush().radius_m, even ? 0 : brush().hardness};
}

} // namespace loam::window
