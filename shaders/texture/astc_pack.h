// The bits of an ASTC block: block mode, integer sequences, void extents. Source as in astc_bits.h.
//
// | bits of a block (one partition) | |
// | 0–10 | block mode: grid width and height, range of the weights |
// | 11–12 | partitions less one: 0 |
// | 13–16 | colour endpoint mode: 8 RGB, 12 RGBA; 6, 10: one colour and a scale |
// | 17… | endpoints r0 r1 g0 g1 b0 b1 (a0 a1) or r g b scale (a0 a1), an integer sequence of the largest range that fits |
// | … | two planes: the channel of the second, two bits |
// | …127 | weights, an integer sequence, from the last bit down; of two planes in turns |
#ifndef LOAM_TEXTURE_ASTC_PACK_H
#define LOAM_TEXTURE_ASTC_PACK_H
#include "shaders/texture/astc_bits.h"
LOAM_BEGIN_SHARED

// The eleven bits of the block mode. Grids of 4×4, 5×4, 5×5, 6×4, 6×5 (width = b + 4, height = a + 2), 4×6, 5×6
// (width = a + 2, height = b + 6) and 6×6 (both six more, weights of at most eight levels).
LOAM_INLINE uint astc_mode_bits(AstcMode m) {
    int low = m.weight.levels < 10 ? m.weight.levels : 0;
    uint high = m.weight.levels < 10 ? 0u : 1u;
    uint r = high == 1u ? (m.weight.levels == 10   ? 2u
                           : m.weight.levels == 12 ? 3u
                           : m.weight.levels == 16 ? 4u
                           : m.weight.levels == 20 ? 5u
                           : m.weight.levels == 24 ? 6u
                                                   : 7u)
                        : (low == 8 ? 7u : uint(low));
    if (m.width == 6 && m.height == 6) return (r >> 1u) << 2u | (r & 1u) << 4u | 1u << 8u;
    uint range_bits = r >> 1u | (r & 1u) << 4u | high << 9u | (m.second_plane < 0 ? 0u : 1u << 10u);
    if (m.height == 6) return range_bits | 3u << 2u | uint(m.width - 2) << 5u;
    return range_bits | uint(m.height - 2) << 5u | uint(m.width - 4) << 7u;
}

LOAM_INLINE uvec4 astc_put(uvec4 block, int at, uint bits) { // as many as fit in 32; above are zeros
    int word = at >> 5;
    uint shift = uint(at & 31);
    block[word] |= bits << shift;
    if (shift != 0u && word < 3) block[word + 1] |= bits >> (32u - shift);
    return block;
}

// Five trits as eight bits, three quints as seven: the inverse of the specification's decoding.
LOAM_INLINE uint astc_trits(uint t0, uint t1, uint t2, uint t3, uint t4) {
    uint c = t2 < 2u ? t2 << 4u | t1 << 2u | t0 : t1 == 2u ? 12u | t0 : t1 << 4u | t0 << 2u | 3u;
    if (t4 < 2u) return t4 << 7u | t3 << 5u | c;
    if (t3 < 2u) return t3 << 7u | 3u << 5u | c;
    return (c & 28u) << 3u | 28u | (c & 3u);
}
LOAM_INLINE uint astc_quints(uint q0, uint q1, uint q2) {
    if (q0 == 4u && q1 == 4u) return q2 == 4u ? 7u : q2 << 3u | 6u;
    uint c = q1 < 4u ? q1 << 3u | q0 : q0 << 3u | 5u;
    if (q2 < 4u) return q2 << 5u | c;
    return (~c >> 1u & 3u) << 5u | (c & 24u) | 6u | (c & 1u);
}

LOAM_INLINE uint astc_mirror(uint x) {
    x = (x & 0x55555555u) << 1u | (x >> 1u & 0x55555555u);
    x = (x & 0x33333333u) << 2u | (x >> 2u & 0x33333333u);
    x = (x & 0x0f0f0f0fu) << 4u | (x >> 4u & 0x0f0f0f0fu);
    x = (x & 0x00ff00ffu) << 8u | (x >> 8u & 0x00ff00ffu);
    return x << 16u | x >> 16u;
}

// A block of one colour, which needs no endpoints: 16 bits a channel.
LOAM_INLINE uvec4 astc_void_extent(vec4 colour) {
    vec4 q = floor(colour * 65535.0f + vec4(0.5f));
    return uvec4(0xfffffdfcu, 0xffffffffu, uint(q.x) | uint(q.y) << 16u, uint(q.z) | uint(q.w) << 16u);
}

// Positions of a block's weights, then of its endpoint values; integer sequences of them.
#define kAstcEndsAt kAstcMaxTexels
LOAM_STATE(AstcSequences)
int astc_sequence[kAstcMaxTexels + 8];

// `count` of them from `from` on, at a bit of a block.
LOAM_INLINE uvec4 astc_put_sequence(uvec4 block, int at, int from, int count, AstcRange r) {
    int group = r.base == 3 ? 5 : r.base == 5 ? 3 : 1;
    LOAM_ROLLED for (int first = 0; first < count; first += group) {
        uint low[5], digit[5];
        LOAM_ROLLED for (int k = 0; k < 5; ++k) {
            bool real = k < group && first + k < count;
            int position = real ? astc_sequence[from + first + k] : 0;
            AstcDigit d = astc_digit(position, r);
            bool pure = r.base == 1 || r.bits == 0;
            digit[k] = r.base == 1 ? 0u : pure ? uint(position) : uint(d.digit);
            low[k] = r.base == 1 ? uint(position) : pure ? 0u : uint(d.upper) << 1u | (d.mirrored ? 1u : 0u);
        }
        uint packed = r.base == 3 ? astc_trits(digit[0], digit[1], digit[2], digit[3], digit[4]) : astc_quints(digit[0], digit[1], digit[2]);
        LOAM_ROLLED for (int k = 0; k < min(group, count - first); ++k) {
            block = astc_put(block, at, low[k]);
            at += r.bits;
            // Bits of the group's digits that follow each value: 2 2 1 2 1 of trits, 3 2 2 of quints.
            int piece = r.base == 1 ? 0 : r.base == 3 ? (k == 2 || k == 4 ? 1 : 2) : (k == 0 ? 3 : 2);
            block = astc_put(block, at, packed & ((1u << uint(piece)) - 1u));
            at += piece;
            packed >>= uint(piece);
        }
    }
    return block;
}

LOAM_INLINE uvec4 astc_pack(AstcMode m) {
    uint endpoint_mode = (m.scaled ? 6u : 8u) + (m.alpha ? 4u : 0u);
    uvec4 block = uvec4(astc_mode_bits(m) | endpoint_mode << 13u, 0u, 0u, 0u);
    LOAM_ROLLED for (int part = 0; part < 2; ++part) {
        AstcRange r = m.colour;
        if (part == 1) r = m.weight;
        uvec4 bits = astc_put_sequence(uvec4(0u), part == 0 ? 17 : 0, part == 0 ? kAstcEndsAt : 0, part == 0 ? astc_values(m) : astc_weights(m), r);
        if (part == 1) bits = uvec4(astc_mirror(bits.w), astc_mirror(bits.z), astc_mirror(bits.y), astc_mirror(bits.x));
        block |= bits;
    }
    if (m.second_plane >= 0) block = astc_put(block, 126 - astc_sequence_bits(astc_weights(m), m.weight), uint(m.second_plane));
    return block;
}
LOAM_END_STATE

LOAM_END_SHARED
#endif
