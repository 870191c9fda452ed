// The shape and marks of an impact crater, the same in GLSL and C++.
//
// Inputs everywhere: `local`: position from the centre, in units of the crater's radius (x east, y north);
// `seed`: the crater's; `age`: 0 fresh … 1 weathered. Everything is exactly 0 for |local| >= the reach named beside
// it. All functions are C1 in position except crater_zone.
//
// Profile over rho = |local| / rim(direction): a bowl -d + (d + h) (2 rho^2 - rho^4) up to the crest at rho =
// 1, then ejecta h (1 - u)^6 (1 + 6 u), which is about rho^-3 (McGetchin et al. 1973) but ends, with slope 0,
// at kCraterEjectaEnd. Rim height: Pike (1977) measured 0.036 D^1.01 km for simple craters, with depth 0.2 D
// below the rim: h is about a third of the depth below the old ground, 0.35 d here, which is 0.14 R for the
// default depth of 0.4 R. Weathering is creep of soil downhill (Fassett and Thomson 2014): it fills the bowl, takes
// more of the sharper rim, and roughness first; rays are the first thing to go, soot washes out.
#ifndef LOAM_CRATER_MATH_H
#define LOAM_CRATER_MATH_H
#include "shaders/document/noise_math.h"
LOAM_BEGIN_SHARED

#define kCraterHeightReach 2.6f  // of crater_height, in radii
#define kCraterMarkReach 3.2f    // of crater_rays, crater_scorch, crater_zone, in radii
#define kCraterRimShare 0.35f    // rim height / depth below the old ground
#define kCraterEjectaEnd 2.36f   // times the largest rim, 1.1, stays below the height reach

// Where the crest lies in this direction (a unit vector), 0.9 … 1.1.
LOAM_INLINE float crater_rim(vec2 direction, uint seed) {
    float low = noise_value(direction * 1.7f, noise_hash(seed + 1u));
    float high = noise_value(direction * 4.3f, noise_hash(seed + 2u));
    return 1.0f + 0.07f * low + 0.03f * high;
}

// Height above the old ground in radii; `depth`: of the fresh bowl below it, in radii.
LOAM_INLINE float crater_height(vec2 local, float depth, uint seed, float age) {
    float r = sqrt(local.x * local.x + local.y * local.y);
    if (r >= kCraterHeightReach) return 0.0f;
    depth *= 1.0f - 0.4f * age;
    float rough = 0.05f * noise_value(local * 3.1f, noise_hash(seed + 4u)) +
                  0.025f * noise_value(local * 7.7f, noise_hash(seed + 5u));
    rough *= 1.0f - 0.75f * age;
    if (r < 1.0e-4f) return depth * (rough - 1.0f);
    vec2 direction = local / r;
    float rho = r / crater_rim(direction, seed);
    if (rho >= kCraterEjectaEnd) return 0.0f;
    float rim = (1.0f - 0.5f * age) *
        depth * kCraterRimShare * (1.0f + 0.3f * noise_value(direction * 2.1f, noise_hash(seed + 3u)));
    if (rho < 1.0f) {
        float rho2 = rho * rho;
        return (depth + rim) * (2.0f * rho2 - rho2 * rho2) - depth + depth * rough;
    }
    float u = (rho - 1.0f) / (kCraterEjectaEnd - 1.0f);
    float rest = 1.0f - u;
    float rest3 = rest * rest * rest;
    return (rim + depth * rough) * rest3 * rest3 * (1.0f + 6.0f * u);
}

// Rays of ejecta: 0 … 1, streaks away from the rim.
LOAM_INLINE float crater_rays(vec2 local, uint seed, float age) {
    float r = sqrt(local.x * local.x + local.y * local.y);
    if (r >= kCraterMarkReach || r < 0.5f || age >= 1.0f) return 0.0f;
    vec2 direction = local / r;
    float streak = noise_value(direction * 4.7f, noise_hash(seed + 11u)) +
                   0.5f * noise_value(direction * 13.0f, noise_hash(seed + 12u));
    float end = 2.5f + 0.65f * noise_value(direction * 6.1f, noise_hash(seed + 13u));
    float broken = 0.75f + 0.25f * noise_value(local * 6.3f, noise_hash(seed + 14u));
    float radial = noise_ramp(0.75f, 1.1f, r) * (1.0f - noise_ramp(1.2f, end, r));
    return (1.0f - age) * noise_ramp(0.1f, 0.7f, streak) * radial * broken;
}

// Burnt ground: 1 in the middle, falling to 0 just outside the rim, with an uneven edge.
LOAM_INLINE float crater_scorch(vec2 local, uint seed, float age) {
    float r = sqrt(local.x * local.x + local.y * local.y);
    if (r >= kCraterMarkReach) return 0.0f;
    float edge = 0.22f * noise_value(local * 2.9f, noise_hash(seed + 21u)) +
                 0.1f * noise_value(local * 8.3f, noise_hash(seed + 22u));
    return (1.0f - 0.8f * age) * (1.0f - noise_ramp(0.3f, 1.2f, r + edge));
}

// Which ground lies here: 0 as it was, 1 the scorched floor, 2 broken rock of rim and rays. What was there grows
// back from outside: weathered there is the floor, as broken rock.
LOAM_INLINE int crater_zone(vec2 local, uint seed, float age) {
    float r = sqrt(local.x * local.x + local.y * local.y);
    if (r >= kCraterMarkReach) return 0;
    float edge = 0.7f * noise_value(local * 3.7f, noise_hash(seed + 31u)) +
                 0.3f * noise_value(local * 9.1f, noise_hash(seed + 32u));
    if (r + 0.14f * edge < 0.72f) return age < 0.5f ? 1 : 2;
    if (r + 0.3f * edge < 1.35f - 0.6f * age) return 2;
    return crater_rays(local, seed, age) > 0.5f + 0.2f * edge ? 2 : 0;
}

LOAM_END_SHARED
#endif
