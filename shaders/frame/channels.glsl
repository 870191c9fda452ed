// What the map's optional channels add to the light of a pixel: scattering, emissive, glint. Thermal is seen by its debug view
// only. Source: Call of Duty talk, "Extra Channel". Nothing of this is evaluated where the map has no channels.
#ifndef LOAM_FRAME_CHANNELS_GLSL
#define LOAM_FRAME_CHANNELS_GLSL
#include "shaders/frame/lighting.glsl"
#include "shaders/texture/page_channels.glsl"

// A place of the world that a float can hold: sector, metres in it [0, 64); footprint axes in metres.
struct GroundPlace {
    ivec2 sector;
    vec2 offset_m;
    float long_m, short_m;
};

// Wrapped diffuse light, normalised so that as much is scattered as before (Green 2004, GPU Gems chapter 16; the factor is
// McAuley's): what the sun side loses comes out beyond the terminator, blue, as the way through snow and ice takes red.
vec3 scattered_light(FrameUniforms u, Surface s, float amount, float visibility) {
    const vec3 kThrough = vec3(0.62, 0.9, 1.25);
    float n_l = dot(s.normal, u.sun_direction.xyz), wrap = 0.7 * amount;
    float wrapped = max(n_l + wrap, 0.0) / ((1.0 + wrap) * (1.0 + wrap));
    float gained = wrapped - max(n_l, 0.0);
    vec3 color = gained > 0.0 ? gained * kThrough : vec3(gained);
    return u.sun_irradiance.rgb * visibility * s.albedo * (1.0 - s.metalness) * 0.31830989 * color;
}

// Embers: dark red to yellow, as steeply as heat radiates. Exposure is divided out: fire is seen by day and night alike.
vec3 emitted_light(FrameUniforms u, float amount) {
    vec3 color = vec3(1.0, 0.06 + 0.5 * amount * amount, 0.3 * amount * amount * amount * amount);
    return color * (amount * amount * 9.0 / max(u.sun_irradiance.w, 1e-3));
}

uint channel_hash(uint v) {
    v = v * 747796405u + 2891336453u;
    v = (v >> ((v >> 28u) + 4u) ^ v) * 277803737u;
    return v >> 22u ^ v;
}

// One facet a cell of 2^level metres, of a chance place and tilt that depend on the cell alone: it sparkles where it mirrors the
// sun into the eye. The point is as large as the pixel's footprint, however near it is, so that none is lost between samples.
vec3 glint_of_cells(GroundPlace at, int level, vec3 normal, vec3 half_way, vec2 away) {
    float cell_m = uintBitsToFloat(uint(127 + level) << 23u);
    vec2 cells = at.offset_m / cell_m, cell = floor(cells);
    uint h = channel_hash(uint(at.sector.x) ^ channel_hash(uint(at.sector.y) + 0x9e3779b9u));
    h = channel_hash(h ^ uint(cell.x) ^ channel_hash(uint(cell.y) ^ uint(level + 64) << 24u));
    uint h2 = channel_hash(h ^ 0x68bc21ebu);
    vec2 center = 0.3 + 0.4 * vec2(h & 1023u, h >> 10u & 1023u) * (1.0 / 1023.0);
    vec2 tilt = vec2(h2 & 1023u, h2 >> 10u & 1023u) * (2.0 / 1023.0) - 1.0;
    vec3 facet = normalize(normal + vec3(tilt * 0.7, 0.0));
    float mirror = max(dot(facet, half_way), 0.0);
    float lobe = exp2((mirror - 1.0) * 900.0);
    vec2 d = (cells - cell - center) * cell_m;
    vec2 along = vec2(dot(d, away) / at.long_m, dot(d, vec2(-away.y, away.x)) / at.short_m);
    float point = exp2(-2.0 * dot(along, along));
    vec3 color = 0.75 + 0.5 * vec3(h2 >> 20u & 15u, h2 >> 24u & 15u, h2 >> 28u) * (1.0 / 15.0);
    return color * (lobe * point);
}

vec3 glint_light(FrameUniforms u, Surface s, float amount, GroundPlace at, vec3 to_eye, float visibility) {
    const float kFinest = -8.0, kCoarsest = 5.0; // log2 metres a cell: 4 mm … 32 m
    vec3 half_way = normalize(u.sun_direction.xyz + to_eye);
    // Cells of four to eight footprints, faded from one size into the next.
    float size = clamp(log2(at.long_m) + 2.5, kFinest, kCoarsest - 1.0), level = floor(size);
    vec2 away = normalize(to_eye.xy + vec2(1e-6, 0.0));
    vec3 fine = glint_of_cells(at, int(level), s.normal, half_way, away);
    vec3 coarse = glint_of_cells(at, int(level) + 1, s.normal, half_way, away);
    // Far points stand for many facets, of which few mirror at once.
    float strength = 30.0 / (1.0 + at.long_m * 12.0);
    return u.sun_irradiance.rgb * visibility * amount * strength * mix(fine, coarse, size - level);
}

vec3 channel_light(FrameUniforms u, Surface s, vec4 places, GroundPlace at, vec3 to_eye, float visibility) {
    vec3 light = vec3(0);
    vec4 channels = channels_from(places);
    if (page_channel_place(kPageChannels, kChannelScattering) != 0u) light += scattered_light(u, s, channels.x, visibility);
    if (page_channel_place(kPageChannels, kChannelEmissive) != 0u) light += emitted_light(u, channels.z);
    if (page_channel_place(kPageChannels, kChannelGlint) != 0u)
        light += glint_light(u, s, channels.w, at, to_eye, visibility);
    return light;
}
#endif
