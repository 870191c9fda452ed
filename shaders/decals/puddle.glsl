// A puddle: still water in a shallow hollow, with a wet rim
//@ fill 0.6 0 1 How full it is
//@ ripple 0.0 0 1 Wind on the water
//@ mud 0.5 0 1 How brown the water is

const float SIZE = 1.4;

float bed(Place at) {
    float uneven = 0.35 * fbm(at.p / SIZE, at.seed, 4) * detail(SIZE, at);
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
    float wet = ramp(-0.35, 0.05, depth);
    vec3 deep = mix(srgb(0.16, 0.19, 0.19), srgb(0.33, 0.27, 0.19), mud);
    s.colour = s.colour * mix(srgb(0.36, 0.31, 0.25), deep, water);
    s.gloss = mix(0.55, 0.97, water);
    s.occlusion = 1.0;
    s.cover = max(water * mix(0.75, 0.95, ramp(0.0, 0.5, depth)), 0.45 * wet);
}
