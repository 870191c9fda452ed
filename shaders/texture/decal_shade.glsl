// What craters and footprints do to the ground's texture: colours and weights to blend over what is there, in the physical
// texture's channels and encodings (texture_io.h). A function of the position relative to the decal and the texel size only.
#ifndef LOAM_TEXTURE_DECAL_SHADE_GLSL
#define LOAM_TEXTURE_DECAL_SHADE_GLSL
#include "shaders/document/crater_math.h"
#include "shaders/document/footprint_math.h"
#include "shaders/texture/decal_io.h"
#include "shaders/texture/page_channels.glsl"
#include "shaders/texture/texture_io.h"

struct DecalShade {
    vec4 albedo;  // square roots of linear values, weight
    vec4 surface; // gloss, normal x, occlusion; weight
    vec4 metal;   // metalness, normal y, not used; weight
    vec4 channels; // optional ones, by place
    float channel_weight; // metal's, or 0 where the channels stay as they are
};

const vec3 kBurntRoot = vec3(0.17, 0.155, 0.14); // soot: about 2.5 % linear
const vec3 kDustRoot = vec3(0.60, 0.565, 0.51);  // pulverised rock: about a third

// Soot neither scatters nor sparkles, and hides what is below it. A hot floor is warm all over, hottest in the middle, and its embers are veins where noise
// crosses zero, which become a glow where they are finer than two texels.
vec4 crater_channels(DecalInstance decal, vec2 offset_m, float scorch) {
    float heat = decal.shape.z;
    float vein_m = max(decal.shape.x * (1.0 / 9.0), 0.05);
    float detail = clamp(vein_m / decal.texel_m * 0.25 - 1.0, 0.0, 1.0);
    vec2 p = offset_m / vein_m;
    precise float wide = noise_value(p, decal.seed + 61u);
    precise float narrow = noise_value(p * 2.7, decal.seed + 62u);
    float vein = 1.0 - clamp(abs(wide + 0.45 * narrow) * 3.5, 0.0, 1.0);
    precise float hot = scorch * scorch * heat;
    precise float ember = clamp(hot * mix(0.22, vein * (0.65 + 0.5 * narrow), detail), 0.0, 1.0);
    return channel_places(float[kChannelCount](0.0, clamp(max(hot * 0.75, ember), 0.0, 1.0), ember, 0.0, 0.0));
}

// offset_m: from the crater's centre.
DecalShade crater_shade(DecalInstance decal, vec2 offset_m) {
    precise vec2 local = offset_m / decal.shape.x;
    precise float scorch = crater_scorch(local, decal.seed, decal.shape.w);
    precise float rays = crater_rays(local, decal.seed, decal.shape.w);
    float cover = max(0.85 * scorch, 0.6 * rays) * decal.fade;
    // Rubble: bumps of a fortieth of the radius, gone where they are smaller than two texels.
    float bump_m = max(decal.shape.x * (1.0 / 40.0), 0.02);
    float detail = clamp(bump_m / decal.texel_m - 1.0, 0.0, 1.0);
    vec2 p = offset_m / bump_m;
    precise float h = noise_value(p, decal.seed + 51u);
    precise float hx = noise_value(p + vec2(0.25, 0.0), decal.seed + 51u);
    precise float hy = noise_value(p + vec2(0.0, 0.25), decal.seed + 51u);
    vec2 slope = vec2(hx - h, hy - h) * detail;
    vec2 normal = -slope / sqrt(1.0 + dot(slope, slope));

    DecalShade shade;
    shade.albedo = vec4(mix(kDustRoot, kBurntRoot, clamp(scorch * 1.2, 0.0, 1.0)) * (1.0 + 0.12 * h * detail), cover);
    shade.surface = vec4(0.12, page_encode_normal(normal.x), 1.0 - 0.25 * detail * max(-h, 0.0), cover);
    shade.metal = vec4(0.0, page_encode_normal(normal.y), 0.0, cover);
    shade.channels = kHasChannels ? crater_channels(decal, offset_m, scorch) : vec4(0);
    shade.channel_weight = cover;
    return shade;
}

// offset_m: from the print's middle.
DecalShade print_shade(DecalInstance decal, vec2 offset_m) {
    float length_m = decal.shape.x, depth_m = decal.shape.y;
    vec2 heading = decal.shape.zw; // sine, cosine
    int foot = int(decal.foot);
    precise vec2 local = footprint_local(offset_m / length_m, heading);
    // Slopes over a texel, at least over a hundredth of the print: what is finer cannot be shown.
    float reach = max(decal.texel_m / length_m, 0.01) * 0.5;
    FootprintMark mark = footprint_mark(local, foot, decal.seed, reach);
    precise vec2 slope_local = mark.slope * (depth_m / length_m);
    vec2 slope = slope_local.x * vec2(heading.y, -heading.x) + slope_local.y * heading;
    vec2 normal = -slope / sqrt(1.0 + dot(slope, slope));
    float inside = (1.0 - noise_ramp(0.62, kFootprintReach, length(local))) * decal.fade;

    DecalShade shade;
    shade.albedo = vec4(vec3(0.2, 0.18, 0.16), 0.5 * mark.pressed * inside);
    shade.surface = vec4(0.1, page_encode_normal(normal.x), 1.0 - 0.35 * mark.pressed, 0.9 * mark.around * inside);
    shade.metal = vec4(0.0, page_encode_normal(normal.y), 0.0, 0.9 * mark.around * inside);
    shade.channels = vec4(0);
    shade.channel_weight = 0.0; // pressed snow scatters as loose snow does
    return shade;
}
#endif
