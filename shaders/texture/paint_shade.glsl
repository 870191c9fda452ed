// What a decal of a material does to the ground's texture: values to blend over what is there and how much of them, in the
// physical texture's channels and encodings. Composition and direct shading evaluate these same functions of the place in
// the frame and the texel's size (paint_io.h).
//
// The includer declares MATERIAL_ALBEDO, MATERIAL_NORMAL, MATERIAL_METAL (the layers' sampler2DArrays), kHasMetal, kSmoothMips, and
// PAINT_SEGMENT(i), a PaintSegment.
#ifndef LOAM_TEXTURE_PAINT_SHADE_GLSL
#define LOAM_TEXTURE_PAINT_SHADE_GLSL
#include "shaders/document/noise_math.h"
#include "shaders/texture/decal_io.h"
#include "shaders/texture/layer_math.h"
#include "shaders/texture/paint_io.h"
#include "shaders/texture/texture_io.h"
#include "shaders/texture/function_calls.glsl"
#include "shaders/texture/decal_functions.glsl"

struct PaintShade {
    vec3 root;       // square root of the linear albedo
    vec2 normal;     // encoded
    float gloss, metalness, occlusion;
    float cover;     // times a channel's share: its weight
    bool failed;     // its function gave no number here, and nothing is shown
};

// Where a place is on a decal: what the material needs of it.
struct PaintPlace {
    vec2 uv;         // repeats of the layer
    vec2 right, up;  // the texture's directions in the frame of the ground
    float texel_m;   // of a texel, as long as it lies on the texture
    float cover;
    fn_Place at;     // what a function is told of it
};

// Coverage, but for opacity, by the distance inside the outline; q: a place on the decal in units of half_m, for the uneven edge.
float paint_edge(PaintDecal decal, float inside_m, float half_m, vec2 q, float texel_m) {
    // Noise finer than two texels of the page is left out, and with it the uneven edge moves to its middle.
    float fine = clamp(half_m * 0.125 / texel_m - 1.0, 0.0, 1.0), coarse = clamp(half_m * 0.5 / texel_m - 1.0, 0.0, 1.0);
    precise float uneven = 0.65 * coarse * noise_value(q * 2.0, noise_hash(decal.seed + 61u)) +
                           0.35 * fine * noise_value(q * 8.0, noise_hash(decal.seed + 62u));
    precise float eaten_m = inside_m - decal.rough * half_m * (0.3 + 0.3 * uneven);
    float soft_m = max(decal.edge * half_m, texel_m);
    return noise_ramp(0.0, soft_m, eaten_m) * decal_fade(2.0 * half_m, texel_m);
}

// local_m: on the decal's own axes.
float paint_outline(PaintDecal decal, vec2 local_m, float texel_m) {
    vec2 half_m = decal.half_m.xy;
    float smaller_m = min(half_m.x, half_m.y);
    vec2 share = abs(local_m) / half_m;
    vec2 beside_m = (1.0 - share) * half_m;
    precise float inside_m = decal.ellipse != 0u ? (1.0 - length(share)) * smaller_m : min(beside_m.x, beside_m.y);
    return paint_edge(decal, inside_m, smaller_m, local_m / smaller_m, texel_m);
}

// at_m: in the frame.
PaintPlace paint_terrain(PaintDecal decal, vec2 at_m, float texel_m) {
    precise vec2 away_m = at_m - decal.center_m.xy;
    precise vec2 local_m = vec2(dot(away_m, decal.axis_x.xy), dot(away_m, decal.axis_y.xy));
    PaintPlace place;
    precise vec2 uv = vec2(dot(at_m, decal.axis_x.xy), dot(at_m, decal.axis_y.xy)) * decal.tiles_per_m + decal.phase;
    place.uv = uv;
    place.right = decal.axis_x.xy;
    place.up = decal.axis_y.xy;
    place.texel_m = texel_m;
    float edge = paint_outline(decal, local_m, texel_m);
    place.cover = edge * decal.opacity;
    place.at = fn_Place(local_m, decal.half_m.xy, edge, texel_m, decal.seed);
    return place;
}

// The nearest segment decides; a piece draws where that is one of its own.
PaintPlace paint_spline(PaintDecal decal, vec2 at_m, float texel_m) {
    float nearest = 3.0e38;
    uint which = 0u;
    for (uint i = 0u; i < decal.segment_count; ++i) {
        PaintSegment s = PAINT_SEGMENT(decal.first_segment + i);
        precise vec2 away_m = at_m - s.from_m;
        precise float along_m = clamp(dot(away_m, s.direction), 0.0, s.length_m);
        precise vec2 aside_m = away_m - s.direction * along_m;
        precise float squared = dot(aside_m, aside_m);
        which = squared < nearest ? i : which;
        nearest = min(squared, nearest);
    }
    PaintSegment s = PAINT_SEGMENT(decal.first_segment + which);
    precise vec2 away_m = at_m - s.from_m;
    precise float along_m = clamp(dot(away_m, s.direction), 0.0, s.length_m);
    vec2 right = vec2(s.direction.y, -s.direction.x);
    precise float across_m = dot(away_m, right);
    float half_m = mix(s.half_from_m, s.half_to_m, along_m / s.length_m);
    float from_start_m = s.start_m + along_m, to_end_m = decal.length_m - from_start_m;
    PaintPlace place;
    precise vec2 uv = vec2(across_m * decal.tiles_per_m, s.phase + along_m * decal.tiles_per_m);
    place.uv = uv;
    place.right = right;
    place.up = s.direction;
    place.texel_m = texel_m;
    float edge = paint_edge(decal, half_m - sqrt(nearest), half_m, vec2(across_m, from_start_m) / half_m, texel_m);
    place.cover = edge * decal.opacity;
    place.at = fn_Place(vec2(across_m, from_start_m), vec2(half_m, decal.length_m), edge, texel_m, decal.seed);
    if (decal.fade_m > 0.0)
        place.cover *= noise_ramp(0.0, decal.fade_m, from_start_m) * noise_ramp(0.0, decal.fade_m, to_end_m);
    if (which < decal.own_first || which >= decal.own_first + decal.own_count) place.cover = 0.0;
    return place;
}

// at_m: in the frame; ground: the height field's normal there. The texture is projected along the decal's z; ground that
// turns away from it is left out.
PaintPlace paint_volume(PaintDecal decal, vec3 at_m, vec3 ground, float texel_m) {
    precise vec3 away_m = at_m - decal.center_m;
    precise vec3 local_m = vec3(dot(away_m, decal.axis_x), dot(away_m, decal.axis_y), dot(away_m, decal.axis_z));
    PaintPlace place;
    precise vec2 uv = vec2(dot(at_m, decal.axis_x), dot(at_m, decal.axis_y)) * decal.tiles_per_m + decal.phase;
    place.uv = uv;
    // How far a step of a texel east or north goes on the texture.
    vec2 slope = -ground.xy / max(ground.z, 0.05);
    vec2 east = vec2(decal.axis_x.x + slope.x * decal.axis_x.z, decal.axis_y.x + slope.x * decal.axis_y.z);
    vec2 north = vec2(decal.axis_x.y + slope.y * decal.axis_x.z, decal.axis_y.y + slope.y * decal.axis_y.z);
    place.texel_m = texel_m * max(sqrt(max(dot(east, east), dot(north, north))), 1.0e-3);
    // The texture's directions laid on the ground, in the frame that a material's normal has there (resolve_common.glsl).
    vec3 ground_east = normalize(vec3(ground.z, 0.0, -ground.x)), ground_north = cross(ground, ground_east);
    place.right = vec2(dot(decal.axis_x, ground_east), dot(decal.axis_x, ground_north));
    place.up = vec2(dot(decal.axis_y, ground_east), dot(decal.axis_y, ground_north));
    float deep = 1.0 - noise_ramp(1.0 - decal.deep_edge, 1.0, abs(local_m.z) / decal.half_m.z);
    float facing = noise_ramp(0.05, 0.35, dot(ground, decal.axis_z));
    float edge = paint_outline(decal, local_m.xy, place.texel_m);
    place.cover = edge * decal.opacity * deep * facing;
    place.at = fn_Place(local_m.xy, decal.half_m.xy, edge, place.texel_m, decal.seed);
    return place;
}

PaintShade paint_material(PaintDecal decal, PaintPlace place) {
    PaintShade shade;
    vec3 uv = vec3(place.uv, float(max(decal.layer, 0)));
    float lod = layer_lod(decal.lod_bias + log2(place.texel_m), kSmoothMips);
    vec3 albedo = textureLod(MATERIAL_ALBEDO, uv, lod).rgb;
    vec4 surface = textureLod(MATERIAL_NORMAL, uv, lod); // normal x, normal y, gloss, occlusion as stored
    float metal = 0.0;
    if (kHasMetal) metal = textureLod(MATERIAL_METAL, uv, lod).r;
    bool flat_colour = decal.layer < 0;
    vec2 n = flat_colour ? vec2(0.0) : surface.xy * (255.0 / 127.0) - 128.0 / 127.0;
    vec3 colour = (flat_colour ? vec3(1.0) : albedo) * decal.colour;
    shade.gloss = flat_colour ? decal.gloss : surface.z;
    shade.metalness = flat_colour ? decal.metalness : metal;
    shade.occlusion = flat_colour ? 1.0 : surface.w;
    shade.cover = place.cover;
    shade.failed = false;
    if (kDecalFunctions && decal.function != 0u) {
        fn_Surface s;
        s.colour = colour;
        s.gloss = shade.gloss;
        s.metalness = shade.metalness;
        s.occlusion = shade.occlusion;
        s.slope = -n / sqrt(max(1.0 - dot(n, n), 0.01));
        s.cover = 1.0;
        run_function(decal, place.at, s);
        if (fn_are_numbers(s)) {
            vec2 slope = clamp(s.slope, -8.0, 8.0);
            n = -slope / sqrt(1.0 + dot(slope, slope));
            colour = s.colour;
            shade.gloss = clamp(s.gloss, 0.0, 1.0);
            shade.metalness = clamp(s.metalness, 0.0, 1.0);
            shade.occlusion = clamp(s.occlusion, 0.0, 1.0);
            shade.cover *= clamp(s.cover, 0.0, 1.0);
        } else {
            shade.failed = shade.cover > 0.0;
            shade.cover = 0.0;
        }
    }
    vec2 normal = place.right * n.x + place.up * n.y;
    shade.root = sqrt(clamp(colour, 0.0, 1.0));
    shade.normal = vec2(page_encode_normal(normal.x), page_encode_normal(normal.y));
    return shade;
}
#endif
