// Scorch: burnt ground with ash in the middle and licks at the rim
//@ burn 0.8 0 1 How black it is
//@ ash 0.4 0 1 How much pale ash lies in the middle
//@ licks 0.5 0 1 How far tongues reach out

void decal(Place at, inout Surface s) {
    vec2 share = at.p / at.half_m;
    float far = length(share);
    float turn = atan(share.y, share.x);
    vec2 around = 2.5 * vec2(cos(turn), sin(turn));
    float tongue = fbm(around + vec2(0.0, far), at.seed, 4);
    float reach = 0.62 + 0.75 * licks * tongue + 0.15 * fbm(share * 4.0, at.seed + 3u, 3);
    float burnt = 1.0 - ramp(reach - 0.35, reach, far);
    float flecks = fbm(at.p * 6.0, at.seed + 5u, 4) * detail(0.16, at);
    float grey = ash * (1.0 - ramp(0.0, 0.45, far + 0.4 * flecks));
    s.colour *= mix(srgb(0.07, 0.06, 0.055), srgb(0.62, 0.60, 0.57), clamp(grey, 0.0, 1.0));
    s.gloss = mix(0.25, 0.08, grey);
    s.occlusion = 1.0 - 0.25 * burnt;
    s.cover = clamp(burnt * burn * (0.85 + 0.5 * flecks), 0.0, 1.0);
}
