// One alpha mask a layer, the baseline that One Material Per Vertex took the place of: every layer whose mask is not 0 at a texel is
// looked up and laid over those before it.
// Source: Call of Duty talk, "Layer Masks".
// The includer declares MATERIAL_MASKS, a sampler2DArray of R8 index pages, one a layer, and includes material.glsl.
#ifndef LOAM_TEXTURE_MASKS_GLSL
#define LOAM_TEXTURE_MASKS_GLSL

// base: the lower left texel in an index page.
MaterialSample evaluate_masks(MaterialCorners c, ivec2 base, uint layer_count) {
    Laid laid = Laid(vec3(0), vec4(0), 0.0, vec4(0));
    vec4 weights = ompv_weights(c.fraction);
    vec3 tint = ompv_decode_tint(ompv_tint(weights, c.t0, c.t1, c.t2, c.t3));
    bool lowest = true;
    for (uint layer = 0u; layer < layer_count; ++layer) {
        ivec3 at = ivec3(base, int(layer));
        vec4 masks = vec4(texelFetch(MATERIAL_MASKS, at, 0).r, texelFetch(MATERIAL_MASKS, at + ivec3(1, 0, 0), 0).r,
                          texelFetch(MATERIAL_MASKS, at + ivec3(0, 1, 0), 0).r,
                          texelFetch(MATERIAL_MASKS, at + ivec3(1, 1, 0), 0).r);
        float alpha = dot(masks, weights);
        if (alpha <= 0.0) continue;
        LayerSample s = sample_layer(c, layer, layer);
        lay_over(laid, s, tint, lowest ? 1.0 : ompv_cover(clamp(2.0 * alpha, 0.0, 1.0), s.albedo_reveal.a));
        lowest = false;
    }
    return finished_material(laid, c.imagery);
}
#endif
