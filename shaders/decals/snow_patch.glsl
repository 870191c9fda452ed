// Snow patch: what is left of a drift, thin and icy at its rim
//@ melt 0.4 0 1 How much of it has gone
//@ dirt 0.25 0 1 Needles and dust on it
//@ drift 2 0.3 20 Size of its bays, metres

float depth_at(Place at) {
    float bays = fbm(at.p / drift, at.seed, 5);
    return at.edge * 1.3 - 0.25 - melt + 0.9 * bays;
}

float relief(Place at) {
    float depth = depth_at(at);
    float cups = cells(at.p / 0.35, at.seed + 3u).x * detail(0.35, at);
    return 0.25 * ramp(0.0, 0.9, depth) + 0.03 * cups * ramp(0.1, 0.5, depth);
}

void decal(Place at, inout Surface s) {
    float depth = depth_at(at);
    float there = ramp(0.0, 0.12, depth);
    float specks = ramp(0.35, 0.75, noise(at.p * 40.0, at.seed + 9u)) * detail(0.025, at);
    float old = 1.0 - ramp(0.1, 0.6, depth);
    vec3 white = mix(srgb(0.95, 0.96, 0.98), srgb(0.78, 0.80, 0.82), 0.6 * old);
    s.colour *= mix(white, srgb(0.22, 0.19, 0.15), dirt * mix(0.15, specks, detail(0.025, at)) * (0.5 + 0.5 * old));
    s.gloss = mix(0.35, 0.65, old);
    s.metalness = 0.0;
    s.occlusion = 1.0;
    s.cover = there;
}
