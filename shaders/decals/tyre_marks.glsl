// Tyre marks: two tracks side by side, for a spline or a long decal
//@ gauge 1.5 0.2 4 From track to track, metres
//@ tyre 0.26 0.05 1 Width of a track, metres
//@ tread 0.09 0.02 0.5 From lug to lug, metres
//@ depth 0.5 0 1 How deep they are pressed in

// 0 beside the track, 1 in it; and across it, -1 to 1.
vec2 track(vec2 p) {
    float across = (abs(p.x) - 0.5 * gauge) / (0.5 * tyre);
    return vec2(1.0 - ramp(0.85, 1.1, abs(across)), across);
}

float lugs(vec2 p) {
    vec2 t = track(p);
    float side = sign(t.y);
    float along = fract((p.y + 0.35 * tread * abs(t.y) * 2.0 + (side > 0.0 ? 0.5 * tread : 0.0)) / tread);
    return t.x * ramp(0.1, 0.25, along) * (1.0 - ramp(0.6, 0.75, along)) * ramp(0.05, 0.2, abs(t.y));
}

float relief(Place at) {
    vec2 t = track(at.p);
    float rim = (1.0 - ramp(0.0, 0.5, abs(abs(t.y) - 1.15))) * 0.3;
    float low = -t.x + rim * (1.0 - t.x);
    return depth * (0.02 * low * detail(0.5 * tyre, at) - 0.008 * lugs(at.p) * detail(0.5 * tread, at));
}

void decal(Place at, inout Surface s) {
    vec2 t = track(at.p);
    float worn = 0.75 + 0.35 * fbm(at.p * vec2(2.0, 0.6), at.seed, 3);
    float pressed = mix(0.4, lugs(at.p), detail(0.5 * tread, at));
    s.colour *= srgb(0.27, 0.22, 0.17) * (1.0 - 0.35 * pressed);
    s.gloss = 0.3 + 0.2 * pressed;
    s.occlusion = 1.0 - 0.4 * depth * t.x;
    s.cover = clamp(t.x * worn * (0.35 + 0.6 * depth), 0.0, 1.0);
}
