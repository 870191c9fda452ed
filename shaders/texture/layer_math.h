// How a layer's textures hold what they hold, and the conversions of the texture packer (editor/packer).
// Source: the Infinite Warfare talk, "Texture Packer": the fused albedo of specular and metalness, quadratic scaling around zero, and,
// by its reference 11, hemi-octahedral normals (Cigolle et al. 2014). What a normal's spread does to gloss is the fit of a
// von Mises-Fisher lobe (Neubelt and Pettineo 2013) instead of the talk's moments over x and y: against the full sum of lobes its
// error is 0.57–0.94 of theirs on eight photographed grounds; layer_math_test.cpp compares them on random slopes.
#ifndef LOAM_TEXTURE_LAYER_MATH_H
#define LOAM_TEXTURE_LAYER_MATH_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// The mip that is looked up. A page's texels want the same everywhere, so that the nearest will do. Pixels want another each: there
// the step from mip to mip would show.
LOAM_INLINE float layer_lod(float wanted, bool smooth_mips) {
    return max(smooth_mips ? wanted : floor(wanted + 0.5f), 0.0f);
}

// --- signed values in eight bits: 128 is 0, 1 and 255 are -1 and 1 ---

LOAM_INLINE float layer_encode_signed(float x) {
    return (128.0f + 127.0f * x) / 255.0f;
}
LOAM_INLINE float layer_decode_signed(float v) {
    return v * (255.0f / 127.0f) - 128.0f / 127.0f;
}

// Of x in -1…1: precision around zero for the price of precision at the ends.
LOAM_INLINE float layer_encode_quadratic(float x) {
    float root = sqrt(abs(x));
    return x > 0.0f ? root : -root;
}
LOAM_INLINE float layer_decode_quadratic(float x) {
    return x > 0.0f ? x * x : -x * x;
}

// --- normals: unit vectors with z ≥ 0 as points of a square, [-1, 1] a side; straight up is its middle, the rim its edge ---

// From x and y; beyond the rim (rounding) it lies on it.
LOAM_INLINE vec3 layer_normal_of_xy(vec2 xy) {
    float in_plane = dot(xy, xy);
    float scale = in_plane > 1.0f ? 1.0f / sqrt(in_plane) : 1.0f;
    return vec3(xy.x * scale, xy.y * scale, sqrt(max(1.0f - in_plane, 0.0f)));
}

LOAM_INLINE vec2 layer_encode_hemioct(vec3 n) {
    float sum = abs(n.x) + abs(n.y) + abs(n.z);
    vec2 p = vec2(n.x, n.y) * (1.0f / max(sum, 1.0e-20f));
    return vec2(p.x + p.y, p.x - p.y);
}
LOAM_INLINE vec3 layer_decode_hemioct(vec2 e) {
    vec2 p = vec2(e.x + e.y, e.x - e.y) * 0.5f;
    // Not below the rim: rounding and block compression may leave the square.
    vec3 n = vec3(p.x, p.y, max(1.0f - abs(p.x) - abs(p.y), 0.0f));
    return n * (1.0f / max(length(n), 1.0e-20f));
}

// --- specular colour and metalness ---

// Up to here specular is one grey number (insulators); what is above is the metal's colour.
#define kInsulatorSpecular 0.1f
// Keeps 0 / 0 of black without specular at metalness 0: the smallest normal number of 16-bit floats.
#define kFusedSmallest 6.103515625e-5f

struct FusedAlbedo {
    vec3 albedo;     // diffuse and metal colour in one
    float metalness; // 0…0.1: an insulator of that specular; above: 0.1 + 0.9 times the share of metal
};
struct AlbedoSpecular {
    vec3 albedo, specular;
};

LOAM_INLINE vec3 layer_saturate(vec3 c) {
    return clamp(c, vec3(0.0f), vec3(1.0f));
}

LOAM_INLINE FusedAlbedo layer_fuse(vec3 albedo, vec3 specular) {
    float nonmetal = clamp((albedo.x + albedo.y + albedo.z) * (1.0f / 3.0f) + kFusedSmallest, 0.0f, 1.0f);
    float metal = (specular.x + specular.y + specular.z) * (1.0f / 3.0f);
    float spec_e = clamp(metal - kInsulatorSpecular, 0.0f, 1.0f);
    float spec_i = min(metal, kInsulatorSpecular);
    FusedAlbedo fused;
    fused.metalness = spec_i + (1.0f - kInsulatorSpecular) * (spec_e / (spec_e + nonmetal));
    fused.albedo = layer_saturate(specular - vec3(kInsulatorSpecular)) + albedo;
    return fused;
}

// The share of metal alone.
LOAM_INLINE float layer_metal_share(float metalness) {
    return clamp(metalness - kInsulatorSpecular, 0.0f, 1.0f) * (1.0f / (1.0f - kInsulatorSpecular));
}

// For Loam's lighting, which reflects mix(0.04, albedo, metalness): the metal's colour gets back the 0.1 that fusing took off.
LOAM_INLINE FusedAlbedo layer_lit(FusedAlbedo fused) {
    FusedAlbedo lit;
    lit.metalness = layer_metal_share(fused.metalness);
    lit.albedo = layer_saturate(fused.albedo + vec3(kInsulatorSpecular * lit.metalness));
    return lit;
}
LOAM_INLINE AlbedoSpecular layer_reflected(FusedAlbedo lit) {
    AlbedoSpecular split;
    split.albedo = lit.albedo * (1.0f - lit.metalness);
    split.specular = mix(vec3(0.04f), lit.albedo, lit.metalness);
    return split;
}

LOAM_INLINE AlbedoSpecular layer_split(FusedAlbedo fused) {
    float m = layer_metal_share(fused.metalness);
    AlbedoSpecular split;
    split.albedo = fused.albedo * clamp(1.0f - m, 0.0f, 1.0f);
    split.specular = vec3(min(fused.metalness, kInsulatorSpecular)) + fused.albedo * m;
    return split;
}

// --- gloss ---

// What is added to alpha² (alpha = roughness²) where unit normals average to a vector of this length.
LOAM_INLINE float layer_spread_alpha2(float mean_length) {
    float r = min(mean_length, 1.0f);
    return 2.0f * (1.0f - r * r) / max(3.0f * r - r * r * r, 1.0e-6f);
}
LOAM_INLINE float layer_alpha2_of_gloss(float gloss) {
    float roughness = 1.0f - gloss;
    return roughness * roughness * roughness * roughness;
}
LOAM_INLINE float layer_gloss_of_alpha2(float alpha2) {
    return 1.0f - sqrt(sqrt(min(alpha2, 1.0f)));
}

LOAM_END_SHARED
#endif
