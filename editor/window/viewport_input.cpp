// Mouse and keyboard over the viewport: who gets the drag, where the cursor meets the ground, and in what order camera,
// tool and document follow within one frame.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "editor/window/app.h"

namespace loam::window {

namespace {

constexpr double kWheelSizeStep = 1.12;

} // namespace

void App::choose_drag(ui::Ui& ui, const ui::ViewportResponse& response) {
    using Drag = CameraInput::Drag;
    if (response.pressed) {
        press_mouse_ = response.mouse;
        const bool alt = ui.mods().alt;
        drag_ = Drag::none;
        tool_drag_ = false;
        if (response.button == ui::MouseButton::right) drag_ = Drag::look;
        else if (response.button == ui::MouseButton::middle) drag_ = Drag::pan;
        else if (alt && ui.mods().shift) drag_ = Drag::pan;
        else if (alt) drag_ = Drag::orbit;
        else tool_drag_ = true;
    }
    if (!response.held && !response.pressed) drag_ = Drag::none;
}

CameraInput App::camera_input(ui::Ui& ui, const ui::ViewportResponse& response, double dt_s) {
    using ui::Key;
    CameraInput input{.drag = drag_,
                      .cursor_px = {response.mouse.x, response.mouse.y},
                      .picture_px = {std::max(1.0f, response.rect.w), std::max(1.0f, response.rect.h)},
                      .under_cursor = cursor_,
                      .dt_s = dt_s};
    if (drag_ != CameraInput::Drag::none) input.moved_px = {response.drag.x, response.drag.y};
    if (response.wheel != 0 && ui.mods().ctrl) resize_brush(std::pow(kWheelSizeStep, response.wheel));
    else if (!tool_drag_) input.wheel = response.wheel;
    if (flying()) {
        const auto pressed = [&](Key key) { return ui.key_is_down(key) ? 1.0 : 0.0; };
        input.ahead = std::max(pressed(Key::w), pressed(Key::up)) - std::max(pressed(Key::s), pressed(Key::down));
        input.right = std::max(pressed(Key::d), pressed(Key::right)) - std::max(pressed(Key::a), pressed(Key::left));
        input.up = pressed(Key::e) - pressed(Key::q);
        input.fast = ui.mods().shift;
    }
    return input;
}

namespace {

// So that it follows the ground.
ToolController::Outline outline_of(const WorldRect& rect) {
    constexpr int kSteps = 8;  // a side
    const glm::dvec2 corners[] = {{rect.min_x, rect.min_y},
                                  {rect.max_x, rect.min_y},
                                  {rect.max_x, rect.max_y},
                                  {rect.min_x, rect.max_y},
                                  {rect.min_x, rect.min_y}};
    ToolController::Outline outline{.places_m = {}, .closed = true};
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < kSteps; ++i)
            outline.places_m.push_back(glm::mix(corners[side], corners[side + 1], double(i) / kSteps));
    return outline;
}

}  // namespace

void App::find_cursor_ground(const ui::ViewportResponse& response) {
    const Camera& eye = camera.camera();
    if ((!response.hovered && !response.held && !response.released) || flying()) {
        cursor_.reset();
        mouse_ = {-1, -1};
        return;
    }
    const bool camera_same =
        eye.position_m == cursor_camera_ && eye.yaw_rad == cursor_yaw_ && eye.pitch_rad == cursor_pitch_;
    const bool mouse_same = response.mouse == mouse_;
    const uint64_t revision = session.document().revision();
    const double time_s = session.document().time_s();
    if (camera_same && mouse_same && revision == cursor_revision_ && time_s == cursor_time_s_) return;
    cursor_time_s_ = time_s;
    cursor_camera_ = eye.position_m;
    cursor_yaw_ = eye.yaw_rad;
    cursor_pitch_ = eye.pitch_rad;
    cursor_revision_ = revision;
    mouse_ = response.mouse;
    if (camera_same && mouse_same && tools.stroking() && cursor_) {
        // The ground rises towards the camera under a resting mouse: without this the brush would creep along the ray.
        cursor_->z = height_at(cursor_->x, cursor_->y);
        return;
    }
    // Under the tool that closes holes the ground is whole.
    const Holes holes = tools.tool == Tool::cutout ? Holes::closed : Holes::open;
    const auto hit =
        session.ray_cast(eye.position_m,
                         eye.ray(response.mouse.x, response.mouse.y, std::max(1.0f, response.rect.w),
                                 std::max(1.0f, response.rect.h)),
                         Session::kLongestRay_m, holes);
    cursor_ = hit ? *hit : std::nullopt;
}

double App::base_height_at(glm::dvec2 at_m) const {
    const Document& document = session.document();
    const glm::dvec2 place = at_m / document.settings().height_spacing_m, first = glm::floor(place);
    int32_t mm[4];
    const auto lock = document.read_lock();
    document.read_heights_mm(0, int(first.x), int(first.y), 2, 2, mm);
    const glm::dvec2 f = place - first;
    return 0.001 * glm::mix(glm::mix(double(mm[0]), double(mm[1]), f.x),
                            glm::mix(double(mm[2]), double(mm[3]), f.x), f.y);
}

// Under the mouse on the ground without operators, which does not move under what is dragged; `near_m`: about
// there. The ray is met by planes as high as the ground is where the last one was.
glm::dvec2 App::base_place_under(const ui::ViewportResponse& response, glm::dvec2 near_m) const {
    const Camera& eye = camera.camera();
    const glm::dvec3 ray = eye.ray(response.mouse.x, response.mouse.y, std::max(1.0f, response.rect.w),
                                   std::max(1.0f, response.rect.h));
    constexpr double kLevel = 1e-3;  // such a ray meets the ground too far away to place anything
    if (ray.z > -kLevel) return near_m;
    double height_m = base_height_at(near_m);
    glm::dvec2 place = near_m;
    for (int i = 0; i < 12; ++i) {
        const double away_m = (height_m - eye.position_m.z) / ray.z;
        if (!(away_m > 0)) return near_m;
        place = glm::dvec2(eye.position_m + ray * away_m);
        height_m += 0.7 * (base_height_at(place) - height_m);
    }
    return place;
}

// Those of the selected operator, and the nearest to the mouse.
void App::find_handles(const ui::ViewportResponse& response) {
    constexpr double kReach_px = 11;
    handles_.clear();
    hot_handle_ = -1;
    const Operator* op = selected_object != 0 && !tools.stroking() ? selected_operator() : nullptr;
    if (!op) {
        handle_held_ = false;
        return;
    }
    handles_ = handles_of(op->shape);
    if (!response.hovered) return;
    const Camera& eye = camera.camera();
    double nearest_px = kReach_px;
    for (size_t i = 0; i < handles_.size(); ++i) {
        const glm::dvec2 at = handles_[i].at_m;
        const auto seen = eye.pixel_of({at, height_at(at.x, at.y)}, response.rect.w, response.rect.h);
        if (!seen) continue;
        const double away_px = std::hypot(seen->x - response.mouse.x, seen->y - response.mouse.y);
        if (away_px >= nearest_px) continue;
        nearest_px = away_px;
        hot_handle_ = int(i);
    }
}

// A handle under the mouse takes the press from the tool; the operator follows it, one step of the history a
// drag.
void App::drag_handle(const ui::ViewportResponse& response) {
    if (response.pressed && tool_drag_ && hot_handle_ >= 0) {
        handle_held_ = true;
        held_handle_ = hot_handle_;
        handle_start_ = handles_[size_t(hot_handle_)];
        handle_to_m_ = handle_start_.at_m;
        handle_mouse_m_ = base_place_under(response, handle_to_m_);
        handle_shape_ = selected_operator()->shape;
        handle_group_ = session.document().next_group();
        tool_drag_ = false;
        return;
    }
    if (!handle_held_) return;
    const glm::dvec2 place = handle_start_.at_m + base_place_under(response, handle_to_m_) - handle_mouse_m_;
    if (response.held && (response.drag.x != 0 || response.drag.y != 0) && place != handle_to_m_) {
        handle_to_m_ = place;
        const glm::dvec3 to(handle_to_m_, base_height_at(handle_to_m_));
        OperatorShape shape = dragged(handle_shape_, handle_start_, to, base_height_at(handle_start_.at_m));
        if (!apply({.body = EditOperatorCommand{.id = selected_object, .shape = std::move(shape), .life = {}},
                    .group = handle_group_}))
            handle_held_ = false;
    }
    if (!response.held) handle_held_ = false;
}

void App::viewport_input(ui::Ui& ui, const ui::ViewportResponse& response, double dt_s) {
    choose_drag(ui, response);
    find_handles(response);
    // The drag's pivot is the ground under the cursor at the press; during an orbit the cursor is not asked for.
    if (drag_ != CameraInput::Drag::orbit || response.pressed) find_cursor_ground(response);
    if (camera.update(camera_input(ui, response, dt_s))) {
        scene_changed_ = true;
        if (!tool_drag_ && drag_ == CameraInput::Drag::none) find_cursor_ground(response);
    }

    drag_handle(response);
    const ui::Vec2 moved = response.mouse - press_mouse_;
    const ToolInput input{.ground = cursor_,
                          .pressed = response.pressed && tool_drag_,
                          .held = response.held && tool_drag_,
                          .released = response.released && tool_drag_,
                          .ctrl = ui.mods().ctrl,
                          .shift = ui.mods().shift,
                          .moved_px = std::hypot(moved.x, moved.y),
                          .camera_yaw_rad = camera.camera().yaw_rad,
                          .dt_s = dt_s,
                          .time_s = time_s()};
    for (const Command& command : tools.update(input))
        if (apply(command)) event_placed(command);
    if (response.released) tool_drag_ = false;
    const bool over_handle = handle_held_ || hot_handle_ >= 0;
    ring_ = drag_ == CameraInput::Drag::none && !over_handle ? tools.ring(input) : std::nullopt;
    outlines_ = tools.outlines(input);
    if (const ObjectRow* selected = selected_object != 0 ? selected_row() : nullptr)
        outlines_.push_back(outline_of(selected->bounds));
    if (response.hovered && !flying()) ui.set_cursor(ui::Cursor::crosshair);
}

} // namespace loam::window
