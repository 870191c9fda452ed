// Depth under the ground's surface, seen from the side: clear ice over stones and cracks. A ray goes on below the surface until it
// is as deep as what the depth channel holds there; the material shown is the one at that place. Depths are metres along the
// surface's normal, and the material lies on the surface as projected from above.
// Source: Call of Duty talk, "Parallax Mapping"; the search is that of Tatarchuk 2006, "Dynamic Parallax Occlusion Mapping": even
// steps, and a line through the last two.
#ifndef LOAM_FRAME_PARALLAX_MATH_H
#define LOAM_FRAME_PARALLAX_MATH_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kParallaxDepth_m 0.25f  // where the channel is 1
#define kParallaxReach_m 0.75f  // the place shown lies no farther than this from the pixel's own

struct ParallaxRay {
    vec2 per_m;    // how far the place moves a metre of depth, metres
    float deepest; // where the ray ends, metres; 0: the ground is seen along its surface, or from nowhere
};

// down: the unit direction from the eye to the pixel; ground: the unit normal there; bound_m: nothing on the map is deeper.
LOAM_INLINE ParallaxRay parallax_ray(vec3 down, vec3 ground, float bound_m) {
    ParallaxRay ray;
    float facing = -dot(down, ground);
    vec3 along = down + ground * facing; // of the surface, as long as the sine
    ray.per_m = vec2(0.0f, 0.0f);
    ray.deepest = 0.0f;
    if (!(facing > 1e-4f)) return ray;
    ray.per_m = vec2(along.x, along.y) / facing;
    float sideways = length(ray.per_m);
    ray.deepest = sideways * bound_m > kParallaxReach_m ? kParallaxReach_m / sideways : bound_m;
    return ray;
}

// The depth at which the ray meets what lies below, metres; what is deeper than the ray goes is met at its end. here_m: the depth
// at the pixel's own place.
#ifdef __cplusplus
template <typename Depth>
inline float parallax_hit(const ParallaxRay& ray, float here_m, int steps, const Depth& depth_at_m)
#else
// The includer defines depth_at_m(moved): the depth at a place that far from the pixel's own, metres.
float parallax_hit(ParallaxRay ray, float here_m, int steps)
#endif
{
    float over = here_m; // how far the ground below is under the ray
    float last = 0.0f, step_m = ray.deepest / float(steps);
    if (!(here_m > 0.0f) || !(step_m > 0.0f)) return 0.0f;
    for (int i = 1; i <= steps; ++i) {
        float at = step_m * float(i);
        float under = depth_at_m(ray.per_m * at) - at;
        if (!(under > 0.0f)) return last + step_m * over / max(over - under, 1e-9f);
        over = under;
        last = at;
    }
    return ray.deepest;
}

LOAM_END_SHARED
#endif
