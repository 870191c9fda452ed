// Gravel scatter: stones of two sizes strewn over the ground
//@ stone 0.06 0.01 0.6 Size of the larger stones, metres
//@ amount 0.6 0 1 How many lie there
//@ tone 0.5 0 1 Dark to pale

// Height in stones and the stone's own number, or nothing between them.
vec2 stones(vec2 p, uint seed, float share) {
    vec3 cell = cells(p, seed);
    float there = step(cell.z, share);
    float radius = 0.28 + 0.2 * fract(cell.z * 37.0);
    float squared = (cell.x * cell.x) / (radius * radius);
    return vec2(there * sqrt(max(1.0 - squared, 0.0)) * radius, fract(cell.z * 91.0));
}

float share_at(Place at) {
    return amount * ramp(0.0, 1.0, at.edge + 0.3 * noise(at.p / (8.0 * stone), at.seed + 1u));
}

float relief(Place at) {
    float share = share_at(at);
    float large = stones(at.p / stone, at.seed, share).x * stone;
    float small = stones(at.p / (0.4 * stone), at.seed + 11u, share).x * 0.4 * stone;
    return max(large * detail(0.5 * stone, at), small * detail(0.2 * stone, at));
}

void decal(Place at, inout Surface s) {
    float share = share_at(at);
    vec2 large = stones(at.p / stone, at.seed, share);
    vec2 small = stones(at.p / (0.4 * stone), at.seed + 11u, share);
    float which = large.x > 0.0 ? large.y : small.y;
    float there = max(step(0.001, large.x), step(0.001, small.x));
    // Too small to be seen one by one: their share of the ground.
    float seen = detail(0.6 * stone, at);
    vec3 rock = mix(srgb(0.30, 0.29, 0.28), srgb(0.68, 0.65, 0.60), tone);
    s.colour *= rock * mix(0.85, 0.6 + 0.8 * which, seen);
    s.gloss = 0.22;
    s.occlusion = mix(0.9, 0.65 + 0.35 * ramp(0.0, 0.25, max(large.x, small.x)), seen);
    s.cover = mix(0.6 * share, there, seen);
}
