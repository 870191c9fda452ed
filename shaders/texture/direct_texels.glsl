// The material under a place as pages hold it, without pages: evaluated at the centres of the texels that a page would have there,
// the second mip as the mean of four, averaged between texels and between the mips in the physical texture's encodings. What is
// left between this and the cached picture is what paging itself does: which page is there, and eight bits a channel.
// Twenty evaluations a pixel.
#ifndef LOAM_TEXTURE_DIRECT_TEXELS_GLSL
#define LOAM_TEXTURE_DIRECT_TEXELS_GLSL
#include "shaders/texture/direct.glsl"
#include "shaders/texture/direct_decals.glsl"

// at_rel_m: camera-relative; ground: the normal there. Between texels the ground is its tangent plane.
MaterialSample direct_texels(vec3 at_rel_m, vec3 ground, float log2_footprint) {
    vec2 rel_m = at_rel_m.xy, slope = -ground.xy / ground.z;
    const float log2_root = log2(64.0 / float(kPagePayload)); // texels of a page that covers a sector
    float wanted = log2_footprint - log2_root;
    float mip = floor(wanted);
    float log2_texel = log2_root + mip, texel_m = exp2(log2_texel);
    // Pages of several sectors begin at multiples of their size.
    vec2 corner_m = mod(vec2(direct.camera_sector), exp2(max(mip, 0.0))) * 64.0 + direct.camera_offset_m;
    vec3 root = vec3(0), surface = vec3(0);
    vec2 metal = vec2(0);
    vec4 channels = vec4(0);
    for (int i = 0; i < 8; ++i) {
        bool second = i >= 4;
        float side_m = second ? 2.0 * texel_m : texel_m;
        vec2 at = (corner_m + rel_m) / side_m - 0.5;
        vec2 whole = floor(at), rest = at - whole;
        vec2 next = vec2(i & 1, i >> 1 & 1);
        vec2 share = mix(1.0 - rest, rest, next);
        float weight = share.x * share.y * (second ? wanted - mip : 1.0 - (wanted - mip));
        vec2 center_m = (whole + next + 0.5) * side_m - corner_m;
        int count = second ? 4 : 1;
        vec3 albedo = vec3(0);
        for (int k = 0; k < count; ++k) {
            vec2 fine_m = center_m + (second ? texel_m * (vec2(k & 1, k >> 1) - 0.5) : vec2(0));
            MaterialSample m = with_decals(direct_material(fine_m, log2_texel, second ? log2_texel + 1.0 : log2_texel),
                                           vec3(fine_m, at_rel_m.z + dot(slope, fine_m - rel_m)), ground, log2_texel);
            float part = 1.0 / float(count);
            albedo += clamp(m.albedo, 0.0, 1.0) * part; // a mip of roots averages the squares
            surface += vec3(m.gloss, page_encode_normal(m.normal.x), m.occlusion) * (part * weight);
            metal += vec2(m.metalness, page_encode_normal(m.normal.y)) * (part * weight);
            channels += m.channels * (part * weight);
        }
        root += sqrt(albedo) * weight;
    }
    MaterialSample m;
    m.albedo = root * root;
    m.gloss = surface.x;
    m.occlusion = surface.z;
    m.metalness = metal.x;
    m.channels = channels;
    m.normal = vec2(page_decode_normal(surface.y), page_decode_normal(metal.y));
    return m;
}
#endif
