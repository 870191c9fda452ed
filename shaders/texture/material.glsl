// The material under a place: the layers of the four index vertices around it, blended (ompv.h). Composition of pages and direct
// shading evaluate this same function.
//
// The includer declares, before including:
//   MATERIAL_ALBEDO, MATERIAL_NORMAL, MATERIAL_METAL   names of the layers' sampler2DArrays (layer_set.h)
//   MATERIAL_DISTORTION                                the distortion map, a sampler2DArray (any one where kDistortion is false)
//   MATERIAL_PLACE(layer)                              the LayerPlace of a layer
//   kOneLayer, kHasMetal, kTileHiding, kDistortion,
//   kTransitions, kVista, kImagery, kSmoothMips                  constants (specialisation or not); the last needs a sampler that blends mips
#ifndef LOAM_TEXTURE_MATERIAL_GLSL
#define LOAM_TEXTURE_MATERIAL_GLSL
#include "shaders/texture/compose_io.h"
#include "shaders/texture/layer_math.h"
#include "shaders/texture/ompv.h"
#include "shaders/texture/page_channels.glsl"
#include "shaders/texture/tile_hiding.h"

// Cosine and sine of sixteenths of a circle.
const float kQ = 0.92387953, kH = 0.70710678, kE = 0.38268343;
const vec2 kTurns[16] = vec2[16](vec2(1, 0), vec2(kQ, kE), vec2(kH, kH), vec2(kE, kQ), vec2(0, 1), vec2(-kE, kQ), vec2(-kH, kH),
                                 vec2(-kQ, kE), vec2(-1, 0), vec2(-kQ, -kE), vec2(-kH, -kH), vec2(-kE, -kQ), vec2(0, -1),
                                 vec2(kE, -kQ), vec2(kH, -kH), vec2(kQ, -kE));

struct MaterialSample {
    vec3 albedo;  // linear
    vec2 normal;  // x, y in the frame of the ground
    float gloss;
    float occlusion;
    float metalness;
    vec4 channels; // optional ones, by place
};

// A layer's amounts at a texel: bright ground scatters, cracks (low reveal) glow and are deep, crystals on top (high reveal)
// sparkle; heat lies evenly. `albedo` is linear and tinted.
vec4 texel_channels(vec4 amounts, vec3 albedo, float reveal) {
    precise float bright = sqrt(clamp(dot(albedo, vec3(0.25, 0.6, 0.15)), 0.0, 1.0));
    precise vec4 channels = amounts * channel_places(float[kChannelCount](bright, 1.0, 1.0 - reveal, reveal, 1.0 - reveal));
    return channels;
}

// The four index vertices around a place, and where it is.
struct MaterialCorners {
    uvec4 layers;       // with kOneLayer only x is looked at: a layer, or with kTileHiding its key
    vec3 t0, t1, t2, t3; // tints, sRGB-encoded
    vec2 fraction;      // of the lookup between the vertices
    vec2 from_vertex;   // of the place itself: the same without distortion
    ivec2 vertex;       // the lower left one, in texels of its level from the map's corner
    int level;
    float index_step;   // an index texel of that level, in units of position
    vec2 position;      // what MATERIAL_PLACE scales
    float log2_texel;   // added to a place's lod_bias
    float vista;        // weight of the magnified lookup (vista.h), with kVista
    vec4 imagery;       // linear colours times their weight, and the weight, with kImagery
};

// How far the lookup of index and tint moves, -1 … 1 of the reach. Source: Call of Duty talk, "Distortion".
vec2 distortion_at(vec2 at, float lod) {
    return textureLod(MATERIAL_DISTORTION, vec3(at, 0.0), max(floor(lod + 0.5), 0.0)).xy;
}

struct LayerSample {
    vec4 albedo_reveal;
    vec4 surface; // normal x, normal y, gloss, occlusion as stored
    float metalness;
    vec4 channels; // amounts
};

// One layer's textures; key: the corner's, which says how they are turned.
LayerSample sample_textures(MaterialCorners c, uint key, LayerPlace place) {
    precise vec2 at = place.offset + c.position * place.scale;
    vec2 turn = vec2(1, 0);
    if (kTileHiding) {
        SectionPlace section = section_place(key, c.vertex, c.level);
        turn = kTurns[key >> 2u & 15u];
        precise vec2 from_middle = (c.from_vertex - section.middle) * (c.index_step * place.scale);
        precise vec2 turned =
            vec2(turn.x * from_middle.x - turn.y * from_middle.y, turn.y * from_middle.x + turn.x * from_middle.y);
        at = turned + section.shift;
    }
    vec3 uv = vec3(at, float(place.slot));
    float lod = layer_lod(place.lod_bias + c.log2_texel, kSmoothMips);
    LayerSample s = LayerSample(textureLod(MATERIAL_ALBEDO, uv, lod), textureLod(MATERIAL_NORMAL, uv, lod), 0.0, place.channels);
    if (kHasMetal) s.metalness = textureLod(MATERIAL_METAL, uv, lod).r;
    if (kTileHiding) { // what is turned one way to be looked up is seen turned the other way
        precise vec2 n = s.surface.xy - 128.0 / 255.0;
        precise vec2 seen = vec2(turn.x * n.x + turn.y * n.y, turn.x * n.y - turn.y * n.x);
        s.surface.xy = seen + 128.0 / 255.0;
    }
    if (kVista) { // never turned: sections are smaller than its repeats
        precise vec2 far = place.vista_offset + c.position * place.vista_scale;
        vec3 far_uv = vec3(far, float(place.slot));
        float far_lod = layer_lod(place.vista_lod_bias + c.log2_texel, kSmoothMips);
        vec3 far_albedo = textureLod(MATERIAL_ALBEDO, far_uv, far_lod).rgb;
        vec4 far_surface = textureLod(MATERIAL_NORMAL, far_uv, far_lod);
        precise vec3 albedo = s.albedo_reveal.rgb * (1.0 - c.vista) + far_albedo * c.vista;
        precise vec4 surface = s.surface * (1.0 - c.vista) + far_surface * c.vista;
        s.albedo_reveal.rgb = albedo;
        s.surface = surface;
        if (kHasMetal) {
            precise float metalness = s.metalness * (1.0 - c.vista) + textureLod(MATERIAL_METAL, far_uv, far_lod).r * c.vista;
            s.metalness = metalness;
        }
    }
    return s;
}

// A layer or a transition: layer `first`, and over it as much of `second` as the threshold and its reveal map let through.
LayerSample sample_layer(MaterialCorners c, uint key, uint layer) {
    LayerPlace place = MATERIAL_PLACE(layer);
    if (!kTransitions) return sample_textures(c, key, place);
    LayerSample shown = LayerSample(vec4(0), vec4(0), 0.0, vec4(0));
    float cover = 1.0;
    uint source = place.first;
    // A loop for the reason that evaluate_material has one: neighbours without a transition end it after one pass.
    for (int side = 0; side < 2; ++side) {
        LayerSample s = sample_textures(c, key, MATERIAL_PLACE(source));
        if (side == 1) cover = ompv_cover(place.threshold, s.albedo_reveal.a);
        precise vec4 albedo_reveal = shown.albedo_reveal * (1.0 - cover) + s.albedo_reveal * cover;
        precise vec4 surface = shown.surface * (1.0 - cover) + s.surface * cover;
        precise float metalness = shown.metalness * (1.0 - cover) + s.metalness * cover;
        precise vec4 channels = shown.channels * (1.0 - cover) + s.channels * cover;
        shown = LayerSample(albedo_reveal, surface, metalness, channels);
        if (place.second == source) break;
        source = place.second;
    }
    return shown;
}

// What has been laid at a place so far, linear and as stored.
struct Laid {
    vec3 albedo;
    vec4 surface; // normal x, normal y, gloss, occlusion
    float metalness;
    vec4 channels;
};

void lay_over(inout Laid laid, LayerSample s, vec3 tint, float cover) {
    precise vec3 albedo = laid.albedo * (1.0 - cover) + s.albedo_reveal.rgb * tint * cover;
    precise vec4 surface = laid.surface * (1.0 - cover) + s.surface * cover;
    laid.albedo = albedo;
    laid.surface = surface;
    if (kHasMetal) {
        precise float metalness = laid.metalness * (1.0 - cover) + s.metalness * cover;
        laid.metalness = metalness;
    }
    if (kHasChannels) {
        precise vec4 here = texel_channels(s.channels, s.albedo_reveal.rgb * tint, s.albedo_reveal.a);
        precise vec4 channels = laid.channels * (1.0 - cover) + here * cover;
        laid.channels = channels;
    }
}

MaterialSample finished_material(Laid laid, vec4 imagery) {
    if (kImagery) { // the layers' relief stays
        precise vec3 far = laid.albedo * (1.0 - imagery.a) + imagery.rgb;
        laid.albedo = far;
    }
    return MaterialSample(laid.albedo, vec2(layer_decode_signed(laid.surface.x), layer_decode_signed(laid.surface.y)),
                          laid.surface.z, laid.surface.w, laid.metalness, laid.channels);
}

MaterialSample evaluate_material(MaterialCorners c) {
    uvec4 keys = c.layers;
    if (kTileHiding && !kOneLayer)
        keys = uvec4(tile_key(keys.x, c.vertex.x, c.vertex.y, c.level), tile_key(keys.y, c.vertex.x + 1, c.vertex.y, c.level),
                     tile_key(keys.z, c.vertex.x, c.vertex.y + 1, c.level),
                     tile_key(keys.w, c.vertex.x + 1, c.vertex.y + 1, c.level));
    vec4 weights = ompv_weights(c.fraction);
    Laid laid = Laid(vec3(0), vec4(0), 0.0, vec4(0));
    uint from = 0u;
    // A loop, not four branches: it ends once eight lanes are done, which branches do not on software devices.
    for (int visit = 0; visit < (kOneLayer ? 1 : 4); ++visit) {
        uint key = kOneLayer ? keys.x : ompv_next(keys, weights, from);
        if (key == kNoLayer) break;
        from = key + 1u;
        vec4 share = kOneLayer ? weights : ompv_share(keys, weights, key);
        vec3 tint = ompv_decode_tint(ompv_tint(share, c.t0, c.t1, c.t2, c.t3));

        LayerSample from_layer = sample_layer(c, key, kTileHiding ? key >> kKeyLayerShift : key);
        float cover = visit == 0 ? 1.0 : ompv_cover(ompv_alpha(ompv_sum(share)), from_layer.albedo_reveal.a);
        lay_over(laid, from_layer, tint, cover);
    }
    return finished_material(laid, c.imagery);
}
#endif
