// The ASTC format as far as the encoder in astc.h writes it: ranges of integers, block modes, the weight grid's infill (astc_pack.h
// has the bits). Source: Khronos Data Format Specification 1.3, "ASTC Compressed Texture Image Formats".
// Positions, not codes: levels of a range are counted in the order of the values they stand for, which for ranges with trits or
// quints is not the order of their codes; the two agree by the mirror symmetry of the specification's tables, so no table is needed.
#ifndef LOAM_TEXTURE_ASTC_BITS_H
#define LOAM_TEXTURE_ASTC_BITS_H
#include "shaders/texture/block.h"
LOAM_BEGIN_SHARED

#define kAstcMaxTexels 36 // of a 6×6 block, and weights of a grid

// Levels = base · 2^bits; base 1, 3 (a trit) or 5 (a quint).
struct AstcRange {
    int levels, base, bits;
};
LOAM_INLINE AstcRange astc_range(int levels) {
    AstcRange r;
    r.levels = levels;
    r.base = levels % 3 == 0 ? 3 : levels % 5 == 0 ? 5 : 1;
    r.bits = 0;
    LOAM_ROLLED for (int reached = r.base; reached < levels; reached *= 2) ++r.bits;
    return r;
}
// Five trits take eight bits, three quints seven; an unfinished group takes what its values need.
LOAM_INLINE int astc_sequence_bits(int count, AstcRange r) {
    return count * r.bits + (r.base == 3 ? (8 * count + 4) / 5 : r.base == 5 ? (7 * count + 2) / 3 : 0);
}

// How endpoints are stored. Direct: both colours (the decoder turns them round where the second is darker, and takes the stored red and
// green as twice the distance from blue then: "contracted"). Scaled: the second colour and, for the first, a factor of it in 256ths.
struct AstcMode {
    int width, height; // of the weight grid
    AstcRange weight, colour;
    bool scaled, alpha;
    int second_plane; // the channel that has weights of its own; -1: none
};
// Weights of the mode, the planes' in turns.
LOAM_INLINE int astc_weights(AstcMode m) {
    return m.width * m.height * (m.second_plane < 0 ? 1 : 2);
}
LOAM_INLINE int astc_values(AstcMode m) {
    return (m.scaled ? 4 : 6) + (m.alpha ? 2 : 0);
}
LOAM_INLINE AstcMode astc_mode(int width, int height, int weight_levels, bool scaled, bool alpha, int second_plane) {
    AstcMode m;
    m.width = width;
    m.height = height;
    m.weight = astc_range(weight_levels);
    m.scaled = scaled;
    m.alpha = alpha;
    m.second_plane = second_plane;
    // The decoder takes the largest range that fits what the weights leave.
    int left = 128 - 17 - (second_plane < 0 ? 0 : 2) - astc_sequence_bits(astc_weights(m), m.weight), best = 6;
    LOAM_ROLLED for (int i = 3; i <= 18; ++i) { // 8, 10, 12, 16 … 256
        int levels = (4 + i % 3) << (i / 3);
        best = astc_sequence_bits(astc_values(m), astc_range(levels)) <= left ? levels : best;
    }
    m.colour = astc_range(best);
    return m;
}

// The modes that the encoder tries.
#define kAstcModes4 8
#define kAstcModes6 8
// Opaque ones chosen greedily among all grids and ranges, by the decibels they add on six photographs of ground; the last is the one that
// two colours of 8 bits need. Grid width, height and two digits of weight levels; negative: scaled; above 10,000: two planes.
LOAM_INLINE int astc_code4(int i, bool alpha) {
    if (i > 4) return i == 5 ? 14404 : i == 6 ? 14405 : alpha ? 14403 : 14406;
    if (alpha) return i == 0 ? 4416 : i == 1 ? -4416 : i == 2 ? -4424 : i == 3 ? 4408 : 4412;
    return i == 0 ? 4416 : i == 1 ? -4424 : i == 2 ? 4424 : i == 3 ? -4432 : 4412;
}
LOAM_INLINE int astc_code6(int i, bool alpha) {
    if (alpha) return i == 0 ? -6604 : i == 1 ? 5604 : i == 2 ? 5506 : i == 3 ? -5508 : i == 4 ? 6604 : i == 5 ? 4408 : i == 6 ? 4412 : 6603;
    return i == 0 ? -6605 : i == 1 ? -5608 : i == 2 ? 6605 : i == 3 ? -6508 : i == 4 ? -6506 : i == 5 ? -6606 : i == 6 ? 5606 : 6603;
}
LOAM_INLINE AstcMode astc_candidate(int side, int i, bool alpha, int odd_channel) {
    int code = side == 4 ? astc_code4(i, alpha) : astc_code6(i, alpha);
    int digits = abs(code);
    return astc_mode(digits / 1000 % 10, digits / 100 % 10, digits % 100, code < 0, alpha, digits < 10000 ? -1 : odd_channel);
}

// Of a range with bits and a trit or quint: levels lie mirrored about the middle; in the lower half the upper bits count first,
// then the trit or quint.
struct AstcDigit {
    int digit, upper; // trit or quint; the bits but the lowest
    bool mirrored;    // the lowest bit
};
LOAM_INLINE AstcDigit astc_digit(int position, AstcRange r) {
    AstcDigit d;
    d.mirrored = position * 2 >= r.levels;
    int from_end = d.mirrored ? r.levels - 1 - position : position;
    d.upper = (from_end * (r.base == 3 ? 342 : 205)) >> 10; // from_end / base below 256: a division is eight on a software device
    d.digit = from_end - d.upper * r.base;
    return d;
}

// 0…64.
LOAM_INLINE int astc_weight_value(int position, AstcRange r) {
    if (r.bits == 0) return position * (r.base == 3 ? 32 : 16);
    if (r.base == 1) {
        int six = r.bits < 3    ? position * (r.bits == 1 ? 63 : 21)
                  : r.bits == 3 ? position * 9
                  : r.bits == 4 ? position << 2 | position >> 2
                                : position << 1 | position >> 4;
        return six > 32 ? six + 1 : six;
    }
    AstcDigit d = astc_digit(position, r);
    int factor = r.levels == 6 ? 50 : r.levels == 10 ? 28 : r.levels == 12 ? 23 : r.levels == 20 ? 13 : 11;
    int offset = d.upper * (r.levels == 12 ? 69 : r.levels == 20 ? 66 : 33);
    int value = (d.digit * factor + offset) >> 2;
    return d.mirrored ? 64 - value : value;
}

// 0…255.
LOAM_INLINE int astc_colour_value(int position, AstcRange r) {
    if (r.base == 1) {
        if (r.bits < 4) return position << 5 | position << 2 | position >> 1;
        return position << (8 - r.bits) | position >> (2 * r.bits - 8);
    }
    AstcDigit d = astc_digit(position, r);
    int n = d.upper;
    int factor, offset;
    int high = n << max(10 - r.bits, 0);
    if (r.base == 3) {
        factor = r.bits == 1 ? 204 : r.bits == 2 ? 93 : r.bits == 3 ? 44 : r.bits == 4 ? 22 : r.bits == 5 ? 11 : 5;
        offset = r.bits == 2 ? n * 278 : r.bits == 3 ? n * 133 : high | n >> max(2 * r.bits - 8, 0);
    } else {
        factor = r.bits == 1 ? 113 : r.bits == 2 ? 54 : r.bits == 3 ? 26 : r.bits == 4 ? 13 : 6;
        offset = r.bits == 2 ? n * 268 : r.bits == 3 ? n * 130 | n >> 1 : high | n >> max(2 * r.bits - 7, 0);
    }
    int value = (d.digit * factor + (r.bits == 1 ? 0 : offset)) >> 2;
    return d.mirrored ? 255 - value : value;
}

// The four grid weights that make the weight of texel i, sixteenths.
struct AstcInfill {
    ivec4 at;
    ivec4 share;
};
LOAM_INLINE AstcInfill astc_infill(int i, int side, AstcMode m) {
    int scale = (1024 + side / 2) / (side - 1);
    int gs = (scale * (i % side) * (m.width - 1) + 32) >> 6;
    int gt = (scale * (i / side) * (m.height - 1) + 32) >> 6;
    int first = (gt >> 4) * m.width + (gs >> 4), last = m.width * m.height - 1;
    int fs = gs & 15, ft = gt & 15;
    int both = (fs * ft + 8) >> 4;
    AstcInfill f;
    f.at = ivec4(first, min(first + 1, last), min(first + m.width, last), min(first + m.width + 1, last));
    f.share = ivec4(16 - fs - ft + both, fs - both, ft - both, both);
    return f;
}

LOAM_END_SHARED
#endif
