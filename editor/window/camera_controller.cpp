#include "editor/window/camera_controller.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace loam::window {

namespace {

constexpr double kRadPerPixel = 0.0035;      // 450 px are a quarter turn
constexpr double kMostPitch_rad = 1.55;      // short of straight up and down: yaw stays meaningful
constexpr double kZoomPerNotch = 0.84;       // of the distance left
constexpr double kNearestZoom_m = 0.4;
constexpr double kSpeedPerNotch = 1.25;
constexpr double kSlowest_m_s = 1.2, kFastest_m_s = 4000;
constexpr double kFastFactor = 4;
constexpr double kEase_s = 0.09;             // time constant of starting and stopping
constexpr double kFlight_s = 0.35;
constexpr double kHighest_m = 60'000, kFarthest_m = 100'000; // from the origin: where doubles and eyes are still at home

} // namespace

CameraController::CameraController(const Camera& camera, HeightAt height_at)
    : camera_(camera), height_at_(std::move(height_at)) {}

void CameraController::set_camera(const Camera& camera) {
    camera_ = camera;
    stop();
}

void CameraController::stop() {
    velocity_m_s_ = glm::dvec3(0);
    flight_.reset();
    jump_.reset();
}

void CameraController::jump_to(const Camera& camera) {
    stop();
    jump_ = Jump{.to = camera};
}

void CameraController::arrive() {
    if (jump_) set_camera(Camera(jump_->to));
}

bool CameraController::advance_jump(double dt_s) {
    if (!jump_) return false;
    jump_->waited_s += dt_s;
    if (jump_->waited_s >= kLongestWait_s) arrive();
    return true;  // also while it waits: the frames until then make its pages
}

std::optional<Camera> CameraController::destination() const {
    if (jump_) return jump_->to;
    if (!flight_) return std::nullopt;
    Camera there = camera_;
    there.position_m = flight_->to_m;
    there.pitch_rad = flight_->to_pitch;
    return there;
}

bool CameraController::moving() const {
    return flight_.has_value() || jump_.has_value() || velocity_m_s_ != glm::dvec3(0);
}

double CameraController::height_above_ground_m() const {
    return std::max(kClearance_m, camera_.position_m.z - height_at_(camera_.position_m.x, camera_.position_m.y));
}

double CameraController::speed_m_s() const {
    return std::clamp(height_above_ground_m() * 1.1, kSlowest_m_s, kFastest_m_s) * speed_factor_;
}

glm::dvec3 CameraController::point_ahead() const {
    return camera_.position_m + camera_.forward() * std::max(4.0, height_above_ground_m() * 2);
}

void CameraController::look(glm::dvec2 moved_px) {
    camera_.yaw_rad = std::remainder(camera_.yaw_rad + moved_px.x * kRadPerPixel, 2 * M_PI);
    camera_.pitch_rad = std::clamp(camera_.pitch_rad - moved_px.y * kRadPerPixel, -kMostPitch_rad, kMostPitch_rad);
}

void CameraController::orbit(glm::dvec2 moved_px) {
    // The pivot keeps its place in the picture: its coordinates along the camera's axes do not change.
    const glm::dvec3 offset = pivot_m_ - camera_.position_m;
    const glm::dvec3 along(glm::dot(offset, camera_.right()), glm::dot(offset, camera_.forward()),
                           glm::dot(offset, camera_.up()));
    look(moved_px);
    camera_.position_m = pivot_m_ - (camera_.right() * along.x + camera_.forward() * along.y + camera_.up() * along.z);
}

void CameraController::pan(const CameraInput& input) {
    const double depth = std::max(0.2, glm::dot(pivot_m_ - camera_.position_m, camera_.forward()));
    const double m_per_px = 2 * std::tan(camera_.fov_y_rad * 0.5) * depth / std::max(1.0, input.picture_px.y);
    camera_.position_m += (camera_.up() * input.moved_px.y - camera_.right() * input.moved_px.x) * m_per_px;
}

void CameraController::zoom(const CameraInput& input) {
    flight_.reset();
    jump_.reset();
    const glm::dvec3 ray =
        camera_.ray(input.cursor_px.x, input.cursor_px.y, input.picture_px.x, input.picture_px.y);
    const double distance = input.under_cursor ? glm::length(*input.under_cursor - camera_.position_m)
                                               : std::max(4.0, height_above_ground_m() * 2);
    const double left = std::max(kNearestZoom_m, distance * std::pow(kZoomPerNotch, input.wheel));
    camera_.position_m += ray * (distance - left);
}

bool CameraController::fly(const CameraInput& input) {
    const bool flying = input.drag == CameraInput::Drag::look;
    glm::dvec3 wish(0);
    if (flying)
        wish = camera_.forward() * input.ahead + camera_.right() * input.right + glm::dvec3(0, 0, 1) * input.up;
    if (glm::length(wish) > 1) wish = glm::normalize(wish);
    wish *= speed_m_s() * (input.fast ? kFastFactor : 1.0);
    velocity_m_s_ = wish + (velocity_m_s_ - wish) * std::exp(-input.dt_s / kEase_s);
    if (wish == glm::dvec3(0) && glm::length(velocity_m_s_) < 0.02 * speed_m_s()) velocity_m_s_ = glm::dvec3(0);
    if (velocity_m_s_ == glm::dvec3(0)) return false;
    camera_.position_m += velocity_m_s_ * input.dt_s;
    return true;
}

void CameraController::frame(glm::dvec3 target_m, double radius_m) {
    velocity_m_s_ = glm::dvec3(0);
    jump_.reset();
    // From the side it is seen now, but never along the ground.
    const double pitch = std::min(camera_.pitch_rad, -0.45);
    Camera there = camera_;
    there.pitch_rad = pitch;
    const double distance = std::max(2.0, radius_m * 2.6 / std::tan(camera_.fov_y_rad * 0.5) * 0.5);
    flight_ = Flight{.from_m = camera_.position_m,
                     .to_m = target_m - there.forward() * distance,
                     .from_pitch = camera_.pitch_rad,
                     .to_pitch = pitch};
    // The yaw stays; the target comes to the middle because the place is chosen so.
}

bool CameraController::advance_flight(double dt_s) {
    if (!flight_) return false;
    flight_->at_s += dt_s;
    const double t = std::clamp(flight_->at_s / kFlight_s, 0.0, 1.0), s = t * t * (3 - 2 * t);
    camera_.position_m = flight_->from_m + (flight_->to_m - flight_->from_m) * s;
    camera_.pitch_rad = flight_->from_pitch + (flight_->to_pitch - flight_->from_pitch) * s;
    if (t >= 1) flight_.reset();
    return true;
}

bool CameraController::rise_above_ground() {
    glm::dvec3& p = camera_.position_m;
    p.x = std::clamp(p.x, -kFarthest_m, kFarthest_m);
    p.y = std::clamp(p.y, -kFarthest_m, kFarthest_m);
    p.z = std::clamp(p.z, -kHighest_m, kHighest_m);
    if (!keep_above_ground) return false;
    const double lowest = height_at_(p.x, p.y) + kClearance_m;
    if (p.z >= lowest) return false;
    p.z = lowest;
    return true;
}

bool CameraController::update(const CameraInput& input) {
    bool moved = false;
    if (input.drag != drag_) {
        drag_ = input.drag;
        pivot_m_ = input.under_cursor.value_or(point_ahead());
        if (drag_ != CameraInput::Drag::none) flight_.reset(), jump_.reset();
    }
    if (drag_ != CameraInput::Drag::none && input.moved_px != glm::dvec2(0)) {
        if (drag_ == CameraInput::Drag::look) look(input.moved_px);
        if (drag_ == CameraInput::Drag::orbit) orbit(input.moved_px);
        if (drag_ == CameraInput::Drag::pan) pan(input);
        moved = true;
    }
    if (input.wheel != 0) {
        if (drag_ == CameraInput::Drag::look) {
            speed_factor_ = std::clamp(speed_factor_ * std::pow(kSpeedPerNotch, input.wheel), 0.02, 50.0);
        } else {
            zoom(input);
            moved = true;
        }
    }
    moved = fly(input) || moved;
    moved = advance_flight(input.dt_s) || moved;
    moved = advance_jump(input.dt_s) || moved;
    // An edit may have raised the ground under a resting camera.
    return rise_above_ground() || moved;
}

} // namespace loam::window
