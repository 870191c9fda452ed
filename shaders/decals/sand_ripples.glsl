// Sand ripples: crests across the wind that fork and fade
//@ spacing 0.25 0.03 5 From crest to crest, metres
//@ height 0.5 0 1 How steep they are
//@ wander 0.5 0 1 How much the crests bend
//@ sand 0.6 0 1 How much the ground takes the colour of sand

// Phase of the ripples: they run across the decal's y.
float phase_at(vec2 p, uint seed) {
    vec2 q = p / spacing;
    float bend = wander * (1.6 * fbm(q * vec2(0.06, 0.11), seed, 3) + 0.25 * noise(q * vec2(0.4, 0.6), seed + 4u));
    return fract(q.y + bend);
}

// Steep to the lee, gentle to the wind.
float crest(float phase) {
    return ramp(0.0, 0.7, phase) * (1.0 - ramp(0.72, 1.0, phase));
}

float strength_at(Place at) {
    return at.edge * ramp(-0.5, 0.2, noise(at.p / (14.0 * spacing), at.seed + 6u));
}

float relief(Place at) {
    return 0.16 * spacing * height * crest(phase_at(at.p, at.seed)) * strength_at(at) * detail(spacing, at);
}

void decal(Place at, inout Surface s) {
    float c = crest(phase_at(at.p, at.seed)) * detail(spacing, at);
    float grain = noise(at.p * 300.0, at.seed + 2u) * detail(0.0035, at);
    vec3 pale = srgb(0.80, 0.70, 0.53);
    s.colour *= mix(vec3(1.0), pale * (0.86 + 0.2 * c + 0.06 * grain), sand);
    s.gloss = 0.15;
    s.occlusion = mix(1.0, 0.85 + 0.15 * c, height);
    s.cover = strength_at(at) * mix(0.6, 1.0, sand);
}
