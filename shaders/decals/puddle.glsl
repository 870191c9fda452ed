// A puddle: still water in a shallow hollow, with a wet rim
//@ fill 0.6 0 1 How full it is
//@ ripple 0.0 0 1 Wind on the water
//@ mud 0.5 0 1 How brown the water is

const float SIZE = 0.9;

float bed(Place at) {
    float uneven = 0.8 * fbm(at.p / SIZE, at.seed, 5) * detail(SIZE, at);
    vec2 share = at.p / at.half_m;
    return 1.0 - dot(share, share) + uneven;
}

float relief(Place at) {
    float wave = noise(at.p * 9.0 + vec2(0.0, 3.0 * noise(at.p, at.seed)), at.seed + 9u);
    float water = ramp(1.0 - fill, 1.15 - fill, bed(at));
    return 0.004 * ripple * wave * water * detail(0.11, at);
}

void decal(Place at, inout Surface s) {
    float depth = bed(at) - (1.0 - fill);
    float water = ramp(0.0, 0.15, depth);
    float wet = ramp(-0.3, 0.05, depth);
    // What it mirrors of the sky, over its bed.
    vec3 deep = mix(srgb(0.36, 0.42, 0.46), srgb(0.42, 0.38, 0.32), mud) * mix(1.15, 0.75, ramp(0.0, 0.5, depth));
    s.colour = s.colour * mix(srgb(0.36, 0.31, 0.25), deep, water);
    s.gloss = mix(0.55, 0.97, water);
    s.occlusion = 1.0;
    s.cover = max(water * mix(0.7, 0.97, ramp(0.0, 0.3, depth)), 0.6 * wet);
}
