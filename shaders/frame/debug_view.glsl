// Debug views (DebugView in runtime/frame/renderer.h), over the lit picture's luminance so that shapes stay readable.
#ifndef LOAM_DEBUG_VIEW_GLSL
#define LOAM_DEBUG_VIEW_GLSL

vec3 hashed_color(uint v) {
    v = v * 747796405u + 2891336453u;
    v = (v >> ((v >> 28u) + 4u) ^ v) * 277803737u;
    v = v >> 22u ^ v;
    return vec3(v & 255u, v >> 8u & 255u, v >> 16u & 255u) / 255.0 * 0.8 + 0.2;
}

vec3 mip_color(int mip) {
    const vec3 kColors[8] = vec3[8](vec3(0.95, 0.95, 0.95), vec3(0.35, 0.8, 0.35), vec3(0.3, 0.55, 0.95), vec3(0.75, 0.4, 0.9),
                                    vec3(0.25, 0.85, 0.85), vec3(0.95, 0.8, 0.25), vec3(0.95, 0.5, 0.2), vec3(0.9, 0.25, 0.25));
    return kColors[clamp(mip, 0, 7)];
}

vec3 debug_color(Pixel p, Surface s, VtSample t, vec3 lit) {
    float light = 0.35 + 0.65 * dot(lit, vec3(0.3, 0.6, 0.1));
    float edge = max(abs(t.page_uv.x - 0.5), abs(t.page_uv.y - 0.5)) > 0.485 ? 0.5 : 1.0;
    switch (push.debug_view) {
        case 1u: return mip_color(t.shown_mip) * light * edge;
        case 2u: return hashed_color(t.id + 1u) * light * edge;
        case 3u: return s.normal * 0.5 + 0.5;
        case 4u: return vec3(p.sky_open * s.occlusion);
        case 5u: return hashed_color(t.word) * light * edge;
        case 6u: return vec3(sun_visibility(u, shadow_atlas, p.rel_m, p.ground, true));
        case 7u: return pow(s.albedo, vec3(1.0 / 2.2));
    }
    return lit;
}
#endif
