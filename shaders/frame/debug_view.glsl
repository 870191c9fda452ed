// Debug views (DebugView in runtime/frame/frame_settings.h), over the lit picture's luminance so that shapes stay readable.
#ifndef LOAM_DEBUG_VIEW_GLSL
#define LOAM_DEBUG_VIEW_GLSL
#include "shaders/frame/debug_io.h"

layout(binding = kDebugFactsSlot, scalar) readonly buffer PlaceFacts { VtPlaceFacts place_facts[]; };

vec3 hashed_color(uint v) {
    v = v * 747796405u + 2891336453u;
    v = (v >> ((v >> 28u) + 4u) ^ v) * 277803737u;
    v = v >> 22u ^ v;
    return vec3(v & 255u, v >> 8u & 255u, v >> 16u & 255u) / 255.0 * 0.8 + 0.2;
}

// Of the page that an indirection texel names.
VtPlaceFacts facts_of(uint word) {
    int pages = int(1.0 / vt.inv_atlas_pages + 0.5);
    int place = int(word >> 8u & 0xffu) * pages + int(word & 0xffu);
    return place_facts[clamp(place, 0, pages * pages - 1)];
}

vec3 facts_color(uint view, VtPlaceFacts f) {
    if (view == kDebugAge) return debug_ramp_color(debug_log_share(float(f.age), kDebugMostFrames));
    if (view == kDebugRequests)
        return f.popularity == 0u ? kDebugUnwanted
                                  : debug_ramp_color(debug_log_share(float(f.popularity), kDebugMostCells));
    if (view == kDebugDirt) return mix(kDebugUnwanted, debug_ramp_color(1.0), f.dirt);
    if (view == kDebugCost) return debug_ramp_color(debug_log_share(f.cost, kDebugMostPages));
    return f.decals == 0u ? kDebugUnwanted : debug_ramp_color(debug_log_share(float(f.decals), kDebugMostDecals));
}

// Cold to hot: blue-black, violet, red, yellow, white.
vec3 heat_color(float heat) {
    const vec3 kColors[6] = vec3[6](vec3(0.02, 0.02, 0.1), vec3(0.25, 0.03, 0.45), vec3(0.75, 0.1, 0.35), vec3(0.95, 0.45, 0.1),
                                    vec3(1.0, 0.85, 0.25), vec3(1.0, 1.0, 0.95));
    float at = clamp(heat, 0.0, 1.0) * 5.0;
    int low = min(int(at), 4);
    return mix(kColors[low], kColors[low + 1], at - float(low));
}

vec3 debug_color(Pixel p, Surface s, VtSample t, vec3 lit) {
    float light = 0.35 + 0.65 * dot(lit, vec3(0.3, 0.6, 0.1));
    float edge = max(abs(t.page_uv.x - 0.5), abs(t.page_uv.y - 0.5)) > 0.485 ? 0.5 : 1.0;
    int wanted = int(floor(t.wanted_mip));
    switch (push.debug_view) {
        case kDebugMips: return debug_step_color(t.shown_mip) * light * edge;
        case kDebugWanted: return debug_step_color(max(wanted, 0)) * light;
        case kDebugCoarser: return debug_step_color(t.shown_mip - max(wanted, 0)) * light * edge;
        case kDebugSectors: return hashed_color(t.id + 1u) * light * edge;
        case kDebugNormals: return s.normal * 0.5 + 0.5;
        case kDebugOcclusion: return vec3(p.sky_open * s.occlusion);
        case kDebugIndirection: return hashed_color(t.word) * light * edge;
        case kDebugShadow: return vec3(sun_visibility(u, shadow_atlas, p.rel_m, p.ground, true));
        case kDebugAlbedo: return pow(s.albedo, vec3(1.0 / 2.2));
        case kDebugAge:
        case kDebugRequests:
        case kDebugDirt:
        case kDebugCost:
        case kDebugDecals: return facts_color(push.debug_view, facts_of(t.word)) * light * edge;
        // Shapes show faintly: what the sun warms is a little warmer than what it does not.
        case kDebugThermal: return heat_color(0.12 * dot(lit, vec3(0.3, 0.6, 0.1)) + 0.88 * channel_at(t.material.channels, kChannelThermal));
    }
    return lit;
}
#endif
