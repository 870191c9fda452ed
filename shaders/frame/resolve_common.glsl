// What the resolves share: where a pixel is, its light. The includer gives the material.
// Slots 0–4: frame, depth, g-buffer, occlusion, shadow atlas; the material's slots follow from kMaterialSlot.
#ifndef LOAM_RESOLVE_COMMON_GLSL
#define LOAM_RESOLVE_COMMON_GLSL
#include "shaders/frame/frame_io.h"
#include "shaders/frame/resolve_io.h"
#include "shaders/frame/channels.glsl"
#include "shaders/frame/lighting.glsl"
#include "shaders/geometry/pixel_ellipse_math.h"

layout(constant_id = 0) const bool kFine = true; // five shadow taps
layout(binding = 0, scalar) readonly buffer Frame { FrameUniforms u; };
layout(binding = 1) uniform sampler2D depth_image;
layout(binding = 2) uniform sampler2D gbuffer_image;
layout(binding = 3) uniform sampler2D occlusion_image;
layout(binding = 4) uniform sampler2DShadow shadow_atlas;
layout(push_constant, scalar) uniform Push { ResolvePush push; };
layout(location = 0) out vec4 out_color;

struct Pixel {
    vec3 rel_m;     // camera-relative
    vec3 ground;    // normal of the height field
    float log2_long, log2_short; // footprint axes, metres
    vec2 axis;      // direction of the long one
    float sky_open; // ambient occlusion of the height field
};

Pixel read_pixel() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(depth_image, at, 0).r;
    vec2 ndc = gl_FragCoord.xy * u.inv_picture_px * 2.0 - 1.0;
    vec4 rel = u.rel_from_clip * vec4(ndc, depth, 1.0);
    vec4 g = texelFetch(gbuffer_image, at, 0);
    Pixel p;
    p.rel_m = rel.xyz / rel.w;
    p.ground = vec3(g.xy, sqrt(max(1.0 - dot(g.xy, g.xy), 1e-4)));
    p.log2_long = g.z;
    p.log2_short = g.w;
    vec2 o = texelFetch(occlusion_image, at, 0).rg;
    p.sky_open = o.x;
    p.axis = decode_axis(o.y);
    return p;
}

// The material's normal on the slope: tangents follow the ground, as the texture is projected from above.
vec3 bent_normal(vec3 ground, vec2 detail) {
    float z = sqrt(max(1.0 - dot(detail, detail), 0.04));
    vec3 east = normalize(vec3(ground.z, 0.0, -ground.x));
    vec3 north = cross(ground, east);
    return normalize(east * detail.x + north * detail.y + ground * z);
}

vec3 lit_pixel(Pixel p, Surface s) {
    float visibility = sun_visibility(u, shadow_atlas, p.rel_m, p.ground, kFine);
    vec3 color = shade(u, s, -normalize(p.rel_m), visibility, p.sky_open);
    return to_screen(u, apply_haze(u, color, p.rel_m));
}

// With what the map's optional channels add. The place is the pixel's: sector of the world and metres in it.
vec3 lit_pixel(Pixel p, Surface s, vec4 channels, ivec2 sector, vec2 offset_m) {
    if (!kHasChannels) return lit_pixel(p, s);
    float visibility = sun_visibility(u, shadow_atlas, p.rel_m, p.ground, kFine);
    vec3 to_eye = -normalize(p.rel_m);
    vec3 color = shade(u, s, to_eye, visibility, p.sky_open);
    GroundPlace at = GroundPlace(sector, offset_m, exp2(p.log2_long), exp2(p.log2_short));
    color += channel_light(u, s, channels, at, to_eye, visibility);
    return to_screen(u, apply_haze(u, color, p.rel_m));
}

#endif
