#include "runtime/frame/camera.h"

#include <algorithm>
#include <cmath>

namespace loam {

glm::dvec3 Camera::forward() const {
    const double c = std::cos(pitch_rad);
    return {std::sin(yaw_rad) * c, std::cos(yaw_rad) * c, std::sin(pitch_rad)};
}

glm::dvec3 Camera::right() const {
    return {std::cos(yaw_rad), -std::sin(yaw_rad), 0};
}

glm::dvec3 Camera::up() const {
    const double s = std::sin(pitch_rad);
    return {-std::sin(yaw_rad) * s, -std::cos(yaw_rad) * s, std::cos(pitch_rad)};
}

glm::dmat4 Camera::clip_from_rel(double width_px, double height_px, glm::dvec2 jitter_px) const {
    const glm::dvec3 r = right(), u = up(), f = forward();
    const double focal = 1.0 / std::tan(fov_y_rad * 0.5);
    const double aspect = width_px / std::max(height_px, 1.0);
    // clip = (x focal / aspect, -y focal, near, depth), depth along `forward`.
    const glm::dvec4 row_x(r * (focal / aspect) + f * (2.0 * jitter_px.x / width_px), 0);
    const glm::dvec4 row_y(-u * focal + f * (2.0 * jitter_px.y / height_px), 0);
    const glm::dvec4 row_z(0, 0, 0, near_m);
    const glm::dvec4 row_w(f, 0);
    return glm::transpose(glm::dmat4(row_x, row_y, row_z, row_w));
}

std::optional<glm::dvec2> Camera::pixel_of(glm::dvec3 at_m, double width_px, double height_px) const {
    const glm::dvec4 c = clip_from_rel(width_px, height_px) * glm::dvec4(at_m - position_m, 1);
    if (!(c.w > 0.05)) return {};
    return glm::dvec2((c.x / c.w * 0.5 + 0.5) * width_px, (c.y / c.w * 0.5 + 0.5) * height_px);
}

glm::dvec3 Camera::ray(double x_px, double y_px, double width_px, double height_px) const {
    const double tan_half = std::tan(fov_y_rad * 0.5);
    const double x = (x_px / width_px * 2.0 - 1.0) * tan_half * width_px / std::max(height_px, 1.0);
    const double y = (1.0 - y_px / height_px * 2.0) * tan_half;
    return glm::normalize(forward() + right() * x + up() * y);
}

Camera Camera::look_at(glm::dvec3 eye, glm::dvec3 target, double fov_y_rad) {
    Camera camera;
    camera.position_m = eye;
    camera.fov_y_rad = fov_y_rad;
    const glm::dvec3 d = target - eye;
    const double across = std::hypot(d.x, d.y);
    camera.yaw_rad = across > 0 ? std::atan2(d.x, d.y) : 0.0;
    camera.pitch_rad = std::atan2(d.z, across);
    return camera;
}

}  // namespace loam
