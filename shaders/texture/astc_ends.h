// Endpoints of an ASTC block: how the decoder reads them, and the ones that fit weights best. Positions are those of astc_bits.h.
#ifndef LOAM_TEXTURE_ASTC_ENDS_H
#define LOAM_TEXTURE_ASTC_ENDS_H
#include "shaders/texture/astc_bits.h"
LOAM_BEGIN_SHARED

// Positions in the mode's colour range; of a scaled mode first.x is the scale. Contracted: as stored, red and green less blue twice.
struct AstcEnds {
    vec4 first, second;
    bool contracted;
};
struct AstcColours {
    vec4 first, second; // 0…1
    float rise;         // of the sum of red, green and blue as stored
};
struct AstcTry {
    float error;
    // With weights given, the error is a quadric of the endpoints, as in bc1.h.
    vec4 aa, ab, bb, ax, bx;
};

LOAM_INLINE vec4 astc_values_of(vec4 positions, AstcRange r) { // 0…255
    vec4 value;
    LOAM_ROLLED for (int c = 0; c < 4; ++c) value[c] = float(astc_colour_value(int(positions[c]), r));
    return value;
}
LOAM_INLINE AstcColours astc_shown(AstcEnds e, AstcMode m) {
    vec4 a = astc_values_of(e.first, m.colour), b = astc_values_of(e.second, m.colour);
    AstcColours c;
    c.rise = b.x + b.y + b.z - a.x - a.y - a.z;
    if (e.contracted) {
        a = floor(vec4(a.x + a.z, a.y + a.z, a.z * 2.0f, a.w * 2.0f) * 0.5f);
        b = floor(vec4(b.x + b.z, b.y + b.z, b.z * 2.0f, b.w * 2.0f) * 0.5f);
    }
    if (m.scaled) a = vec4(floor(b.x * a.x * (1.0f / 256.0f)), floor(b.y * a.x * (1.0f / 256.0f)), floor(b.z * a.x * (1.0f / 256.0f)), a.w);
    c.first = a * (1.0f / 255.0f);
    c.second = b * (1.0f / 255.0f);
    return c;
}
// A colour of 0…1 at the nearest positions.
LOAM_INLINE vec4 astc_position(vec4 colour, AstcRange r) {
    return floor(clamp(colour, vec4(0.0f), vec4(1.0f)) * float(r.levels - 1) + vec4(0.5f));
}
LOAM_INLINE AstcEnds astc_direct_ends(vec4 first, vec4 second, AstcRange r) {
    AstcEnds e;
    e.first = astc_position(first, r);
    e.second = astc_position(second, r);
    e.contracted = false;
    return e;
}
// As the decoder contracts them: halves the steps of red and green.
LOAM_INLINE vec4 astc_spread(vec4 colour) {
    return vec4(colour.x * 2.0f - colour.z, colour.y * 2.0f - colour.z, colour.z, colour.w);
}
LOAM_INLINE bool astc_inside(vec4 c) {
    return min(c.x, c.y) >= 0.0f && max(c.x, c.y) <= 1.0f;
}

LOAM_INLINE float astc_quadric_error(AstcTry t, AstcColours c, vec4 root_weights) {
    vec4 a = c.first * root_weights, b = c.second * root_weights;
    return dot(a * a, t.aa) + 2.0f * dot(a * b, t.ab) + dot(b * b, t.bb) - 2.0f * (dot(a, t.ax * root_weights) + dot(b, t.bx * root_weights));
}

// One colour and the scale of the other with (nearly) the least error for the weights measured, from a guess of the scale.
LOAM_INLINE AstcEnds astc_scaled_ends(AstcTry t, vec4 first, vec4 second, AstcRange r, vec4 root_weights) {
    vec3 roots = vec3(root_weights.x, root_weights.y, root_weights.z);
    vec3 a = vec3(first.x, first.y, first.z) * roots, b = vec3(second.x, second.y, second.z) * roots;
    float scale = clamp(dot(a, b) * (1.0f / max(dot(b, b), 1.0e-6f)), 0.0f, 1.0f);
    vec4 colour = (t.ax * scale + t.bx) * (1.0f / max(scale * scale * t.aa.x + 2.0f * scale * t.ab.x + t.bb.x, 1.0e-6f));
    AstcEnds e = astc_direct_ends(first, vec4(colour.x, colour.y, colour.z, second.w), r);
    vec3 c = vec3(clamp(colour, vec4(0.0f), vec4(1.0f))) * roots;
    scale = (dot(c, vec3(t.ax.x, t.ax.y, t.ax.z) * roots) * (1.0f / max(dot(c, c), 1.0e-6f)) - t.ab.x) * (1.0f / max(t.aa.x, 1.0e-6f));
    e.first = vec4(astc_position(vec4(scale * (256.0f / 255.0f)), r).x, 0.0f, 0.0f, e.first.w);
    return e;
}

// Endpoints with (nearly) the least error for the weights measured; those given where no others are better.
LOAM_INLINE AstcEnds astc_refine(AstcTry t, AstcEnds e, AstcMode m, vec4 root_weights) {
    vec4 det = t.aa * t.bb - t.ab * t.ab;
    if (min(min(det.x, det.y), min(det.z, det.w)) < 1.0e-3f) return e; // weights all equal
    vec4 inv = vec4(1.0f) / det;
    vec4 first = clamp((t.ax * t.bb - t.bx * t.ab) * inv, vec4(0.0f), vec4(1.0f));
    vec4 second = clamp((t.bx * t.aa - t.ax * t.ab) * inv, vec4(0.0f), vec4(1.0f));
    AstcEnds best = e;
    float least = 1.0e9f;
    LOAM_ROLLED for (int n = 0; n < 3; ++n) { // the given, directly (or scaled), contracted
        vec4 a = n == 2 ? astc_spread(first) : first, b = n == 2 ? astc_spread(second) : second;
        AstcEnds other = astc_direct_ends(a, b, m.colour);
        other.contracted = n == 2;
        if (m.scaled) other = astc_scaled_ends(t, first, second, m.colour, root_weights);
        if (n == 0) other = e;
        AstcColours shown = astc_shown(other, m);
        // The decoder tells contracted ones by the sums.
        bool possible = n < 2 || (!m.scaled && astc_inside(a) && astc_inside(b) && shown.rise != 0.0f);
        float error = astc_quadric_error(t, shown, root_weights);
        if (possible && error < least) {
            best = other;
            least = error;
        }
    }
    return best;
}

LOAM_END_SHARED
#endif
