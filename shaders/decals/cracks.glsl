// Cracked mud: plates with dark gaps between them, edges curled up
//@ plate 0.35 0.05 2 Size of a plate, metres
//@ gap 0.05 0.01 0.3 Width of the gaps, share of a plate
//@ curl 0.5 0 1 How far the edges of plates rise
//@ dry 0.7 0 1 How pale the plates are

vec3 plates(vec2 p, uint seed) {
    vec2 bent = p / plate + 0.25 * vec2(noise(p / plate * 1.7, seed + 3u), noise(p / plate * 1.7, seed + 4u));
    return cells(bent, seed);
}

float relief(Place at) {
    float border = plates(at.p, at.seed).y;
    float edge = ramp(0.5 * gap, 1.5 * gap, border);
    float lip = curl * (1.0 - ramp(gap, 4.0 * gap, border));
    float deep = mix(0.3, 1.0, detail(2.0 * gap * plate, at));
    return plate * deep * (0.05 * edge + 0.04 * lip * edge) * detail(0.5 * plate, at);
}

void decal(Place at, inout Surface s) {
    vec3 cell = plates(at.p, at.seed);
    float shows = detail(plate * 2.0 * gap, at);
    float open = (1.0 - ramp(0.4 * gap, 1.2 * gap, cell.y)) * shows + 2.0 * gap * (1.0 - shows);
    vec3 clay = mix(srgb(0.40, 0.33, 0.26), srgb(0.66, 0.60, 0.51), dry);
    clay *= 0.85 + 0.3 * cell.z;
    s.colour *= mix(clay, srgb(0.13, 0.10, 0.08), open);
    s.gloss = mix(0.25 - 0.1 * dry, 0.05, open);
    s.occlusion *= 1.0 - 0.7 * open;
    float ragged = at.edge + 0.5 * (cell.z - 0.5);
    s.cover = ramp(0.35, 0.6, ragged);
}
