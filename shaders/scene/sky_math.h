// Sky and sun by a closed form: single scattering through a flat atmosphere of molecules (Rayleigh) and haze (Mie). The CPU
// takes the light's colours from it, the sky pass the background, so that haze, ambient light and sky agree.
// Differs from full models (Bruneton, Hillaire): no multiple scattering but a constant share, no ozone.
#ifndef LOAM_SKY_MATH_H
#define LOAM_SKY_MATH_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// Vertical optical depths at 680, 550, 440 nm: scattering coefficient at sea level times scale height (8 km; 1.2 km).
#define kRayleighDepth vec3(0.046f, 0.108f, 0.265f)
#define kMieDepth 0.030f

// Relative length of air along a direction, 1 at the zenith, about 38 at the horizon (Kasten and Young 1989).
LOAM_INLINE float air_mass(float sin_elevation) {
    float s = clamp(sin_elevation, 0.0f, 1.0f);
    // Arcsine by its series; above 40 degrees the formula hardly depends on the angle any more.
    float degrees = 57.29578f * (s + s * s * s * (0.1666667f + 0.075f * s * s));
    return 1.0f / (s + 0.50572f * exp2(-1.6364f * log2(degrees + 6.07995f)));
}

// Share of sunlight that arrives through the atmosphere.
LOAM_INLINE vec3 sun_transmittance(float sin_elevation) {
    vec3 depth = (kRayleighDepth + vec3(kMieDepth)) * air_mass(sin_elevation);
    return vec3(exp(-depth.x), exp(-depth.y), exp(-depth.z));
}

LOAM_INLINE float rayleigh_phase(float cos_angle) {
    return 0.0596831f * (1.0f + cos_angle * cos_angle); // 3/(16 pi)
}
// Henyey-Greenstein, normalised over the sphere.
LOAM_INLINE float mie_phase(float cos_angle) {
    const float g = 0.76f;
    float d = 1.0f + g * g - 2.0f * g * cos_angle;
    return 0.0795775f * (1.0f - g * g) / (d * sqrt(d));
}

// Radiance of the sky per unit of the sun's irradiance above the atmosphere, without the sun's disc.
LOAM_INLINE vec3 sky_radiance(vec3 direction, vec3 to_sun) {
    float mass = air_mass(max(direction.z, 0.0f));
    float cos_angle = dot(direction, to_sun);
    vec3 depth = kRayleighDepth + vec3(kMieDepth);
    vec3 along = vec3(1.0f - exp(-depth.x * mass), 1.0f - exp(-depth.y * mass), 1.0f - exp(-depth.z * mass));
    vec3 phase = (kRayleighDepth * rayleigh_phase(cos_angle) + vec3(kMieDepth * mie_phase(cos_angle))) / depth;
    // Sunlight is dimmed on its way to where it scatters, less than on its whole way down; light scattered more
    // than once adds a share that has no direction.
    vec3 lit = sun_transmittance(max(to_sun.z, 0.0f) * 0.7f + 0.12f);
    vec3 many = vec3(0.034f, 0.041f, 0.050f) * (0.3f + max(to_sun.z, 0.0f));
    return along * (phase * lit + many);
}

LOAM_END_SHARED
#endif
