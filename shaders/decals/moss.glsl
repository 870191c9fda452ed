// Moss: soft cushions that grow together
//@ growth 0.55 0 1 How much of the ground it covers
//@ cushion 0.3 0.05 2 Size of a cushion, metres
//@ damp 0.4 0 1 How deep its green is

float mound(vec2 p, uint seed) {
    float wide = 0.5 + 0.5 * fbm(p / (6.0 * cushion), seed, 3);
    float near = 1.0 - cells(p / cushion, seed + 7u).x;
    return 0.6 * wide + 0.4 * near;
}

float relief(Place at) {
    float height = ramp(0.75 - growth * 0.6, 1.1 - growth * 0.4, mound(at.p, at.seed));
    float tips = noise(at.p * 160.0, at.seed + 2u) * detail(0.006, at);
    return height * (0.12 * cushion + 0.0012 * tips) * detail(0.3 * cushion, at);
}

void decal(Place at, inout Surface s) {
    float m = mound(at.p, at.seed) + 0.35 * (at.edge - 1.0);
    float there = ramp(0.72 - growth * 0.6, 0.84 - growth * 0.55, m);
    float shade = 0.5 + 0.5 * fbm(at.p * 14.0, at.seed + 5u, 3) * detail(0.07, at);
    vec3 green = mix(srgb(0.40, 0.44, 0.19), srgb(0.17, 0.26, 0.10), damp);
    s.colour *= mix(green, green * vec3(1.3, 1.2, 0.85), shade * there);
    s.gloss = mix(0.12, 0.3, damp);
    s.metalness = 0.0;
    s.occlusion = mix(0.75, 1.0, ramp(0.5, 1.0, m));
    s.cover = there;
}
