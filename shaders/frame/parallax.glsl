// Where the material of a pixel is looked up, on maps whose layers ask for depth. The includer defines PARALLAX_DEPTH(rel_m): what
// the depth channel holds at a place, camera-relative metres, 0 … 1.
// Specialisation constant 46: steps of the search; 0: no layer asks, and nothing is evaluated.
#ifndef LOAM_FRAME_PARALLAX_GLSL
#define LOAM_FRAME_PARALLAX_GLSL

layout(constant_id = 46) const int kParallaxSteps = 0;
vec2 parallax_from; // the pixel's own place, camera-relative metres
#define depth_at_m(moved) (PARALLAX_DEPTH(parallax_from + (moved)) * kParallaxDepth_m)
#include "shaders/frame/parallax_math.h"

vec2 parallax_place(Pixel p) {
    if (kParallaxSteps == 0) return p.rel_m.xy;
    parallax_from = p.rel_m.xy;
    ParallaxRay ray = parallax_ray(normalize(p.rel_m), p.ground, push.deepest_m);
    // Less than half a pixel cannot be seen: the search ends at some distance by itself.
    float most_m = ray.deepest * length(ray.per_m);
    float here_m = most_m > 0.5 * exp2(p.log2_short) ? depth_at_m(vec2(0)) : 0.0;
    return parallax_from + ray.per_m * parallax_hit(ray, here_m, kParallaxSteps);
}
#endif
