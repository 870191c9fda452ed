// Sun and sky as the frame's uniforms see them: colours from the closed form in shaders/scene/sky_math.h.
#pragma once

#include <glm/vec3.hpp>

#include "shaders/frame/frame_io.h"

namespace loam {

struct SunSky {
    double azimuth_rad = 3.9;    // clockwise from north
    double elevation_rad = 0.6;  // above the horizon
    double haze_per_km = 0.045;  // extinction at height 0
    double eye_height_m = 0;
};

// Direction to the sun.
[[nodiscard]] glm::dvec3 sun_direction(const SunSky& sky);
// Fills the sun's, sky's and haze's members.
void fill_sun_sky(const SunSky& sky, shared::FrameUniforms& uniforms);

}  // namespace loam
