// Footpath: ground trodden bare, for a spline or a long decal
//@ worn 0.6 0 1 How bare it is
//@ wander 0.5 0 1 How far the feet stray
//@ stones 0.3 0 1 Stones that have come up

// Share of the half width from the middle of the path, which strays.
float aside(Place at) {
    float stray = 0.35 * wander * fbm(vec2(at.p.y / (3.0 * at.half_m.x), 0.0), at.seed, 3);
    return abs(at.p.x / at.half_m.x - stray);
}

float relief(Place at) {
    float low = 1.0 - ramp(0.15, 0.75, aside(at));
    float lumps = fbm(at.p * 5.0, at.seed + 3u, 3) * detail(0.2, at);
    vec3 cell = cells(at.p * 9.0, at.seed + 6u);
    float stone = step(cell.z, 0.6 * stones) * max(0.0, 0.3 - cell.x) * detail(0.06, at);
    return low * worn * (-0.06 + 0.012 * lumps) + 0.07 * stone * low;
}

void decal(Place at, inout Surface s) {
    float ragged = 0.35 * fbm(at.p * 2.2, at.seed + 1u, 4);
    float bare = 1.0 - ramp(0.25 + 0.3 * worn, 0.55 + 0.35 * worn, aside(at) + ragged * 0.6);
    float tread = 0.5 + 0.5 * fbm(at.p * 8.0, at.seed + 2u, 3) * detail(0.12, at);
    vec3 cell = cells(at.p * 9.0, at.seed + 6u);
    float stone = step(cell.z, 0.6 * stones) * (1.0 - ramp(0.22, 0.3, cell.x)) * detail(0.06, at);
    vec3 earth = mix(srgb(0.38, 0.30, 0.22), srgb(0.56, 0.48, 0.38), tread);
    s.colour *= mix(earth, srgb(0.55, 0.53, 0.50), stone);
    s.gloss = mix(0.15, 0.3, stone);
    s.occlusion = 1.0 - 0.15 * bare;
    s.cover = bare * (0.35 + 0.6 * worn);
}
