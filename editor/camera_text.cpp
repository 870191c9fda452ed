// Cameras as written on the command line.
#include <numbers>

#include "editor/session.h"
#include "editor/text_numbers.h"

namespace loam {

namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

Status check_fov(double fov_deg) {
    if (fov_deg < 1 || fov_deg > 170) return error("field of view {} is outside 1 … 170 degrees", fov_deg);
    return {};
}

}  // namespace

Result<Camera> parse_camera(std::string_view text) {
    auto numbers = parse_numbers(text);
    if (!numbers) return error("camera \"{}\": {}", text, numbers.message());
    const std::vector<double>& v = *numbers;
    if (v.size() != 5 && v.size() != 6)
        return error("camera \"{}\" has {} numbers, expected x,y,z,yaw_deg,pitch_deg[,fov_deg]", text,
                     v.size());
    if (v[4] < -90 || v[4] > 90)
        return error("camera \"{}\": pitch {} is outside -90 … 90 degrees", text, v[4]);
    Camera camera;
    camera.position_m = {v[0], v[1], v[2]};
    camera.yaw_rad = v[3] * kDegree_rad;
    camera.pitch_rad = v[4] * kDegree_rad;
    if (v.size() == 6) {
        LOAM_TRY(check_fov(v[5]));
        camera.fov_y_rad = v[5] * kDegree_rad;
    }
    return camera;
}

Result<Camera> parse_look_at(std::string_view text) {
    auto numbers = parse_numbers(text);
    if (!numbers) return error("look-at \"{}\": {}", text, numbers.message());
    const std::vector<double>& v = *numbers;
    if (v.size() != 6 && v.size() != 7)
        return error("look-at \"{}\" has {} numbers, expected eye x,y,z and target x,y,z[,fov_deg]", text,
                     v.size());
    const glm::dvec3 eye(v[0], v[1], v[2]), target(v[3], v[4], v[5]);
    if (eye == target) return error("look-at \"{}\": eye and target are the same point", text);
    double fov_y_rad = 1.0;
    if (v.size() == 7) {
        LOAM_TRY(check_fov(v[6]));
        fov_y_rad = v[6] * kDegree_rad;
    }
    return Camera::look_at(eye, target, fov_y_rad);
}

}  // namespace loam
