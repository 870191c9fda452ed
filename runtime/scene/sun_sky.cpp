#include "runtime/scene/sun_sky.h"

#include <algorithm>
#include <cmath>

#include "shaders/scene/sky_math.h"

namespace loam {

namespace {

// Irradiance above the atmosphere in the renderer's unit: chosen so that exposure 1 suits a clear noon.
constexpr float kSunAbove = 12.0f;
constexpr float kSunAngularRadius_rad = 0.00465f;
constexpr float kHazeScaleHeight_m = 1200.0f;  // as of the Mie depth
constexpr float kGroundAlbedo = 0.16f;         // of the land around, for light from below

// Cosine-weighted mean of the sky's radiance over the upper hemisphere (irradiance / pi).
glm::vec3 mean_sky(const glm::vec3& to_sun) {
    constexpr int kRings = 16, kSpokes = 32;
    glm::vec3 sum(0);
    for (int r = 0; r < kRings; ++r)
        for (int s = 0; s < kSpokes; ++s) {
            // Equal parts of the projected disc, so every direction weighs the same.
            const float radius = std::sqrt((float(r) + 0.5f) / kRings);
            const float angle = (float(s) + 0.5f) / kSpokes * 6.2831853f;
            sum += shared::sky_radiance(
                {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1.0f - radius * radius)},
                to_sun);
        }
    return sum / float(kRings * kSpokes);
}

}  // namespace

glm::dvec3 sun_direction(const SunSky& sky) {
    const double c = std::cos(sky.elevation_rad);
    return {std::sin(sky.azimuth_rad) * c, std::cos(sky.azimuth_rad) * c, std::sin(sky.elevation_rad)};
}

void fill_sun_sky(const SunSky& sky, shared::FrameUniforms& u) {
    const glm::vec3 to_sun(sun_direction(sky));
    const glm::vec3 transmitted = shared::sun_transmittance(std::max(to_sun.z, 0.0f));
    // The sun fades as it sinks below the horizon rather than going out at once.
    const float up = std::clamp(to_sun.z * 20.0f + 0.5f, 0.0f, 1.0f);
    const glm::vec3 irradiance = transmitted * kSunAbove * up;
    const glm::vec3 ambient = mean_sky(to_sun) * kSunAbove;
    // Level ground's light decides the exposure: a grey of 0.18 ends near the middle of the picture's range.
    const float level = (irradiance.y * std::max(to_sun.z, 0.0f) / 3.1416f + ambient.y);
    const float exposure = 1.2f / std::max(level, 0.05f);

    // Haze is as bright as the sky that stands right above the horizon, so that far ground melts into it.
    const glm::vec3 side = glm::normalize(glm::vec3(-to_sun.y, to_sun.x, 0.05f));
    const glm::vec3 toward = glm::normalize(glm::vec3(to_sun.x, to_sun.y, std::max(0.06f, to_sun.z * 0.25f)));
    const glm::vec3 horizon = shared::sky_radiance(side, to_sun) * kSunAbove;
    const glm::vec3 glow = glm::max(shared::sky_radiance(toward, to_sun) * kSunAbove - horizon, glm::vec3(0));

    const float thinned = std::exp(-std::clamp(float(sky.eye_height_m) / kHazeScaleHeight_m, -4.0f, 30.0f));
    u.sun_direction = glm::vec4(to_sun, std::cos(kSunAngularRadius_rad));
    u.sun_irradiance = glm::vec4(irradiance, exposure);
    u.sun_above = glm::vec4(glm::vec3(kSunAbove), 0);
    u.sky_ambient = glm::vec4(ambient, float(sky.haze_per_km) * 0.001f * thinned);
    u.ground_bounce = glm::vec4((irradiance * std::max(to_sun.z, 0.0f) / 3.1416f + ambient) * kGroundAlbedo,
                                kHazeScaleHeight_m);
    u.haze_color = glm::vec4(horizon, 0);
    u.haze_sunward = glm::vec4(glow, 0);
}

}  // namespace loam
