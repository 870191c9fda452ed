// Frost: crystals in feathers over the ground, thicker in patches
//@ cold 0.55 0 1 How much of the ground is white
//@ feather 0.25 0.03 2 Size of a feather, metres
//@ sparkle 0.5 0 1 How glossy the crystals are

float rime(Place at) {
    float patches = fbm(at.p / (8.0 * feather), at.seed, 4);
    // Folded noise draws branches.
    vec2 q = at.p / feather;
    float fold = 0.0;
    float share = 0.5;
    float size = feather;
    for (int i = 0; i < 3; ++i) {
        // Those finer than texels can show are their mean.
        fold += share * mix(0.72, 1.0 - abs(noise(q, at.seed + 10u)), detail(2.5 * size, at));
        size /= 2.1;
        q = vec2(0.8 * q.x - 0.6 * q.y, 0.6 * q.x + 0.8 * q.y) * 2.1;
        share *= 0.55;
    }
    return ramp(0.4, 0.95, fold) + 0.6 * patches;
}

float relief(Place at) {
    return 0.006 * feather * rime(at) * detail(0.25 * feather, at);
}

void decal(Place at, inout Surface s) {
    float white = ramp(0.0, 1.2, rime(at) - 0.8 + 1.3 * cold * at.edge);
    s.colour *= srgb(0.90, 0.94, 0.98);
    float crystal = mix(0.5, random(at.p / 0.006, at.seed + 3u), detail(0.006, at));
    s.gloss = mix(0.35, 0.75, sparkle * crystal);
    s.metalness = 0.0;
    s.occlusion = 1.0;
    s.cover = 0.9 * white;
}
