// Oil: a dark spill with drops around it and a sheen of colours
//@ amount 0.6 0 1 How much was spilt
//@ sheen 0.6 0 1 Colours of thin oil
//@ soaked 0.3 0 1 How far it has gone into the ground

float film(Place at) {
    vec2 share = at.p / at.half_m;
    float blot = 0.3 + 0.55 * amount - length(share) + 0.45 * fbm(share * 2.2, at.seed, 4);
    vec3 drop = cells(share * 5.0, at.seed + 4u);
    float drops = (drop.z < 0.35 * amount ? 0.22 - drop.x : -1.0) * (1.0 - ramp(0.6, 1.0, length(share)));
    return max(blot, drops);
}

void decal(Place at, inout Surface s) {
    float thick = film(at);
    float there = ramp(0.0, 0.06, thick);
    float halo = soaked * ramp(-0.25, 0.0, thick);
    // Bands where the film is thin.
    float bands = 22.0 * thick + 1.5 * noise(at.p * 3.0, at.seed + 8u);
    vec3 rainbow = 0.5 + 0.5 * cos(bands + vec3(0.0, 2.1, 4.2));
    float thin = there * (1.0 - ramp(0.03, 0.3, thick));
    vec3 dark = srgb(0.06, 0.05, 0.045);
    s.colour *= mix(dark, 0.16 * rainbow, sheen * thin);
    s.gloss = mix(0.45, mix(0.92, 0.6, soaked), there);
    s.metalness = 0.35 * sheen * thin;
    s.occlusion = 1.0;
    s.cover = max(0.95 * there, 0.55 * halo);
}
