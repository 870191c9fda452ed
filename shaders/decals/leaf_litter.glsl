// Leaf litter: fallen leaves, each turned its own way
//@ leaf 0.07 0.02 0.4 Length of a leaf, metres
//@ amount 0.65 0 1 How thick they lie
//@ autumn 0.6 0 1 From green over yellow to brown

// How much of a leaf is there (its height, 0 none) and its number.
vec2 leaves(vec2 p, uint seed, float share) {
    vec2 cell = floor(p);
    vec2 found = vec2(0.0);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            vec2 here = cell + vec2(float(x), float(y));
            float number = random(here, seed);
            float turn = 6.2832 * random(here, seed + 1u);
            vec2 away = p - here - 0.2 - 0.6 * vec2(random(here, seed + 2u), random(here, seed + 3u));
            vec2 along = vec2(cos(turn), sin(turn));
            vec2 own = vec2(dot(away, along), dot(away, vec2(-along.y, along.x)));
            // A lens: pointed at both ends.
            float width = 0.32 * (1.0 - own.x * own.x / 0.36);
            float inside = width - abs(own.y);
            float height = inside > 0.0 && number < share ? 0.3 + number : 0.0;
            float vein = abs(own.y) < 0.03 ? 0.12 : 0.0;
            found = height > found.x ? vec2(height, fract(number * 17.0) - vein) : found;
        }
    }
    return found;
}

float share_at(Place at) {
    return amount * ramp(0.1, 0.9, at.edge + 0.4 * noise(at.p / (9.0 * leaf), at.seed + 8u));
}

float relief(Place at) {
    return 0.05 * leaf * leaves(at.p / leaf, at.seed, share_at(at)).x * detail(0.5 * leaf, at);
}

void decal(Place at, inout Surface s) {
    float share = share_at(at);
    vec2 lying = leaves(at.p / leaf, at.seed, share);
    vec2 below = leaves(at.p / leaf + 37.3, at.seed + 21u, share);
    vec2 top = lying.x > 0.0 ? lying : below;
    float seen = detail(0.5 * leaf, at);
    float age = clamp(autumn * 1.4 + 0.5 * (mix(0.5, top.y, seen) - 0.5), 0.0, 1.4);
    age += 0.35 * fbm(at.p / (6.0 * leaf), at.seed + 30u, 3);
    vec3 leaf_colour = mix(srgb(0.33, 0.37, 0.17), srgb(0.62, 0.46, 0.22), ramp(0.1, 0.7, age));
    leaf_colour = mix(leaf_colour, srgb(0.36, 0.25, 0.17), ramp(0.55, 1.1, age));
    s.colour *= leaf_colour * (0.7 + 0.5 * mix(0.5, top.y, seen));
    s.gloss = 0.2;
    s.occlusion = mix(0.85, lying.x > 0.0 ? 1.0 : 0.6, seen);
    float there = top.x > 0.0 ? 1.0 : 0.0;
    s.cover = mix(min(1.0, 1.1 * share), there, seen);
}
