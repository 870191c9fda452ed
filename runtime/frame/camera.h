// A camera in world metres. Yaw is clockwise from north, pitch is up from the horizon.
#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace loam {

struct Camera {
    glm::dvec3 position_m{0, 0, 100};
    double yaw_rad = 0;
    double pitch_rad = -0.3;
    double fov_y_rad = 1.0;
    double near_m =
        0.004;  // below the 1 cm that an eye may come to the ground; reversed Z loses nothing by it

    [[nodiscard]] glm::dvec3 forward() const;
    [[nodiscard]] glm::dvec3 right() const;
    [[nodiscard]] glm::dvec3 up() const;
    // Camera-relative metres to clip space: reversed Z, infinite far plane, Y down as in Vulkan. `jitter_px`
    // moves the picture by part of a pixel (accumulated supersampling).
    [[nodiscard]] glm::dmat4 clip_from_rel(double width_px, double height_px,
                                           glm::dvec2 jitter_px = {0, 0}) const;
    // Direction through a pixel (0,0 = upper left corner of the picture), normalised.
    [[nodiscard]] glm::dvec3 ray(double x_px, double y_px, double width_px, double height_px) const;
    // Where a place in the world is in the picture; none behind the camera.
    [[nodiscard]] std::optional<glm::dvec2> pixel_of(glm::dvec3 at_m, double width_px,
                                                     double height_px) const;
    // Looks from `eye` to `target`; straight up or down keeps the yaw.
    [[nodiscard]] static Camera look_at(glm::dvec3 eye, glm::dvec3 target, double fov_y_rad = 1.0);
};

}  // namespace loam
