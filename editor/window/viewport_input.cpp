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

void App::viewport_input(ui::Ui& ui, const ui::ViewportResponse& response, double dt_s) {
    choose_drag(ui, response);
    // The drag's pivot is the ground under the cursor at the press; during an orbit the cursor is not asked for.
    if (drag_ != CameraInput::Drag::orbit || response.pressed) find_cursor_ground(response);
    if (camera.update(camera_input(ui, response, dt_s))) {
        scene_changed_ = true;
        if (!tool_drag_ && drag_ == CameraInput::Drag::none) find_cursor_ground(response);
    }

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
    ring_ = drag_ == CameraInput::Drag::none ? tools.ring(input) : std::nullopt;
    outlines_ = tools.outlines(input);
    if (const ObjectRow* selected = selected_object != 0 ? selected_row() : nullptr)
        outlines_.push_back(outline_of(selected->bounds));
    if (response.hovered && !flying()) ui.set_cursor(ui::Cursor::crosshair);
}

} // namespace loam::window
