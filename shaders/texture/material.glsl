// The material under a place: the layers of the four index vertices around it, blended (ompv.h). Composition of pages and direct
// shading evaluate this same function.
//
// The includer declares, before including:
//   MATERIAL_ALBEDO, MATERIAL_NORMAL, MATERIAL_METAL   names of the layers' sampler2DArrays (layer_set.h)
//   MATERIAL_PLACE(layer)                              the LayerPlace of a layer
//   kOneLayer, kHasMetal                               constants (specialisation or not)
#ifndef LOAM_TEXTURE_MATERIAL_GLSL
#define LOAM_TEXTURE_MATERIAL_GLSL
#include "shaders/texture/compose_io.h"
#include "shaders/texture/ompv.h"

struct MaterialSample {
    vec3 albedo;  // linear
    vec2 normal;  // x, y in the frame of the ground
    float gloss;
    float occlusion;
    float metalness;
};

// layers, tints (sRGB-encoded): of the four corners; fraction: between them; position: what MATERIAL_PLACE scales;
// log2_texel: added to a place's lod_bias. With kOneLayer only layers.x is looked at.
MaterialSample evaluate_material(uvec4 layers, vec3 t0, vec3 t1, vec3 t2, vec3 t3, vec2 fraction, vec2 position,
                                 float log2_texel) {
    vec4 weights = ompv_weights(fraction);
    MaterialSample material;
    material.metalness = 0.0;
    vec3 albedo = vec3(0);
    vec4 surface = vec4(0); // normal x, normal y, gloss, occlusion as stored
    float metalness = 0.0;
    uint from = 0u;
    // A loop, not four branches: it ends once eight lanes are done, which branches do not on software devices.
    for (int visit = 0; visit < (kOneLayer ? 1 : 4); ++visit) {
        uint layer = kOneLayer ? layers.x : ompv_next(layers, weights, from);
        if (layer == kNoLayer) break;
        from = layer + 1u;
        vec4 share = kOneLayer ? weights : ompv_share(layers, weights, layer);
        vec3 tint = ompv_decode_tint(ompv_tint(share, t0, t1, t2, t3));

        LayerPlace place = MATERIAL_PLACE(layer);
        precise vec2 at = place.offset + position * place.scale;
        vec3 uv = vec3(at, float(layer));
        float lod = max(floor(place.lod_bias + log2_texel + 0.5), 0.0);
        vec4 albedo_reveal = textureLod(MATERIAL_ALBEDO, uv, lod);
        vec4 layer_surface = textureLod(MATERIAL_NORMAL, uv, lod);

        float cover = visit == 0 ? 1.0 : ompv_cover(ompv_alpha(ompv_sum(share)), albedo_reveal.a);
        precise vec3 next_albedo = albedo * (1.0 - cover) + albedo_reveal.rgb * tint * cover;
        precise vec4 next_surface = surface * (1.0 - cover) + layer_surface * cover;
        albedo = next_albedo;
        surface = next_surface;
        if (kHasMetal) {
            precise float next_metal = metalness * (1.0 - cover) + textureLod(MATERIAL_METAL, uv, lod).r * cover;
            metalness = next_metal;
        }
    }
    material.albedo = albedo;
    material.normal = surface.xy * (255.0 / 127.0) - 128.0 / 127.0; // 128 is a flat normal's byte
    material.gloss = surface.z;
    material.occlusion = surface.w;
    material.metalness = metalness;
    return material;
}
#endif
