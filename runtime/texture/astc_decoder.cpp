// Source: Khronos Data Format Specification 1.3, "ASTC Compressed Texture Image Formats": block mode, integer
// sequence decoding, unquantisation, weight infill, endpoint modes 6, 8, 10 and 12, void extents. No
// partitions, no high range.
#include "runtime/texture/astc_decoder.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace loam {

namespace {

using Block = std::array<uint32_t, 4>;

uint32_t bit(const Block& block, int at) {
    return block[size_t(at / 32)] >> (at % 32) & 1u;
}
int field(const Block& block, int at, int count) {
    uint32_t value = 0;
    for (int i = 0; i < count; ++i) value |= bit(block, at + i) << i;
    return int(value);
}

struct Range {
    int bits = 0;
    bool trits = false, quints = false;
    [[nodiscard]] int size_bits(int count) const {
        return count * bits + (trits ? (8 * count + 4) / 5 : 0) + (quints ? (7 * count + 2) / 3 : 0);
    }
};
struct Mode {
    int width = 0, height = 0;
    Range weights;
    int planes = 1;
};

// Table of the two-dimensional block modes; none where it is reserved.
std::optional<Mode> read_mode(const Block& block) {
    const int mode = field(block, 0, 11), a = mode >> 5 & 3, b = mode >> 7 & 3;
    const auto r0 = mode >> 4 & 1;
    Mode m;
    int r = 0;
    bool high = mode >> 9 & 1, two_planes = mode >> 10 & 1;
    if ((mode & 3) != 0) {
        r = (mode & 3) << 1 | r0;
        switch (mode >> 2 & 3) {
            case 0:
                m = {b + 4, a + 2, {}};
                break;
            case 1:
                m = {b + 8, a + 2, {}};
                break;
            case 2:
                m = {a + 2, b + 8, {}};
                break;
            default:
                m = (b & 2) ? Mode{(b & 1) + 2, a + 2, {}} : Mode{a + 2, (b & 1) + 6, {}};
        }
    } else {
        r = (mode >> 2 & 3) << 1 | r0;
        switch (b) {
            case 0:
                m = {12, a + 2, {}};
                break;
            case 1:
                m = {a + 2, 12, {}};
                break;
            case 2:
                m = {a + 6, (mode >> 9 & 3) + 6, {}};
                high = two_planes = false;
                break;
            default:
                if (a > 1) return std::nullopt;
                m = a == 0 ? Mode{6, 10, {}} : Mode{10, 6, {}};
        }
    }
    if (r < 2) return std::nullopt;
    m.planes = two_planes ? 2 : 1;
    static constexpr Range kRanges[2][6] = {
        {{1}, {0, true}, {2}, {0, false, true}, {1, true}, {3}},
        {{1, false, true}, {2, true}, {4}, {2, false, true}, {3, true}, {5}}};
    m.weights = kRanges[high ? 1 : 0][r - 2];
    return m;
}

struct Value {
    int bits = 0, digit = 0;  // digit: the trit or quint
};

void decode_trits(int t, int (&out)[5]) {
    int c = 0;
    if ((t >> 2 & 7) == 7) {
        c = (t >> 5 & 7) << 2 | (t & 3);
        out[4] = out[3] = 2;
    } else {
        c = t & 31;
        const bool two = (t >> 5 & 3) == 3;
        out[4] = two ? 2 : t >> 7 & 1;
        out[3] = two ? t >> 7 & 1 : t >> 5 & 3;
    }
    if ((c & 3) == 3) {
        out[2] = 2;
        out[1] = c >> 4 & 1;
        out[0] = (c >> 3 & 1) << 1 | ((c >> 2 & 1) & ~(c >> 3 & 1));
    } else if ((c >> 2 & 3) == 3) {
        out[2] = out[1] = 2;
        out[0] = c & 3;
    } else {
        out[2] = c >> 4 & 1;
        out[1] = c >> 2 & 3;
        out[0] = (c >> 1 & 1) << 1 | ((c & 1) & ~(c >> 1 & 1));
    }
}

void decode_quints(int q, int (&out)[5]) {
    int c = 0;
    if ((q >> 1 & 3) == 3 && (q >> 5 & 3) == 0) {
        const int low = q & 1;
        out[2] = low << 2 | ((q >> 4 & 1) & ~low) << 1 | ((q >> 3 & 1) & ~low);
        out[1] = out[0] = 4;
        return;
    }
    if ((q >> 1 & 3) == 3) {
        out[2] = 4;
        c = (q >> 3 & 3) << 3 | (~(q >> 5) & 3) << 1 | (q & 1);
    } else {
        out[2] = q >> 5 & 3;
        c = q & 31;
    }
    const bool four = (c & 7) == 5;
    out[1] = four ? 4 : c >> 3 & 3;
    out[0] = four ? c >> 3 & 3 : c & 7;
}

// Bits beyond the sequence's end count as zeros.
void read_sequence(const Block& block, int at, int count, Range range, Value* out) {
    const int end = at + range.size_bits(count), group = range.trits ? 5 : range.quints ? 3 : 1;
    const auto take = [&](int bits) {
        const int there = std::clamp(end - at, 0, bits), value = field(block, at, there);
        at += bits;
        return value;
    };
    static constexpr int kTritBits[5] = {2, 2, 1, 2, 1}, kQuintBits[3] = {3, 2, 2};
    for (int first = 0; first < count; first += group) {
        int packed = 0, filled = 0, digits[5] = {}, low[5] = {};
        for (int k = 0; k < group; ++k) {
            low[k] = take(range.bits);
            const int bits = range.trits ? kTritBits[k] : range.quints ? kQuintBits[k] : 0;
            packed |= take(bits) << filled;
            filled += bits;
        }
        if (range.trits) decode_trits(packed, digits);
        if (range.quints) decode_quints(packed, digits);
        for (int k = 0; k < group && first + k < count; ++k) out[first + k] = {low[k], digits[k]};
    }
}

// Bits a (the lowest) … f spread as the specification's strings say, highest first.
int spread(const char* pattern, int bits) {
    int value = 0;
    for (; *pattern; ++pattern) value = value << 1 | (*pattern == '0' ? 0 : bits >> (*pattern - 'a') & 1);
    return value;
}
int replicate(int value, int bits, int to) {
    int out = 0;
    for (int filled = 0; filled < to; filled += bits) out = out << bits | value;
    const int over = (to + bits - 1) / bits * bits - to;
    return out >> over;
}

int weight_of(Value v, Range range) {
    int out = 0;
    if (range.bits == 0) {
        static constexpr int kTrit[3] = {0, 32, 63}, kQuint[5] = {0, 16, 32, 47, 63};
        out = range.trits ? kTrit[v.digit] : kQuint[v.digit];
    } else if (!range.trits && !range.quints) {
        out = replicate(v.bits, range.bits, 6);
    } else {
        static constexpr int kTritC[3] = {50, 23, 11}, kQuintC[2] = {28, 13};
        static constexpr const char* kTritB[3] = {"0000000", "b000b0b", "cb000cb"};
        static constexpr const char* kQuintB[2] = {"0000000", "b0000b0"};
        const size_t n = size_t(range.bits - 1);
        const int a = (v.bits & 1) ? 0x7f : 0;
        const int t = (v.digit * (range.trits ? kTritC[n] : kQuintC[n]) +
                       spread(range.trits ? kTritB[n] : kQuintB[n], v.bits)) ^
                      a;
        out = (a & 0x20) | t >> 2;
    }
    return out > 32 ? out + 1 : out;
}

int colour_of(Value v, Range range) {
    if (!range.trits && !range.quints) return replicate(v.bits, range.bits, 8);
    static constexpr int kTritC[6] = {204, 93, 44, 22, 11, 5}, kQuintC[5] = {113, 54, 26, 13, 6};
    static constexpr const char* kTritB[6] = {"000000000", "b000b0bb0", "cb000cbcb",
                                              "dcb000dcb", "edcb000ed", "fedcb000f"};
    static constexpr const char* kQuintB[5] = {"000000000", "b0000bb00", "cb0000cbc", "dcb0000dc",
                                               "edcb0000e"};
    const size_t n = size_t(range.bits - 1);
    const int a = (v.bits & 1) ? 0x1ff : 0;
    const int t = (v.digit * (range.trits ? kTritC[n] : kQuintC[n]) +
                   spread(range.trits ? kTritB[n] : kQuintB[n], v.bits)) ^
                  a;
    return (a & 0x80) | t >> 2;
}

// Endpoints fill what is left with the largest range that fits, of 256, 192, 160, 128 … 6 levels.
Range colour_range(int left, int values) {
    static constexpr Range kRanges[] = {{8}, {6, true}, {5, false, true}, {7}, {5, true}, {4, false, true},
                                        {6}, {4, true}, {3, false, true}, {5}, {3, true}, {2, false, true},
                                        {4}, {2, true}, {1, false, true}, {3}, {1, true}};
    return *std::find_if(std::begin(kRanges), std::end(kRanges) - 1,
                         [&](const Range& range) { return range.size_bits(values) <= left; });
}

struct Ends {
    glm::ivec4 first, second;
};
Ends endpoints_of(const int* v, bool scaled, bool alpha) {
    Ends e;
    if (scaled) {
        e.second = {v[0], v[1], v[2], alpha ? v[5] : 255};
        e.first = {v[0] * v[3] >> 8, v[1] * v[3] >> 8, v[2] * v[3] >> 8, alpha ? v[4] : 255};
        return e;
    }
    const glm::ivec4 a(v[0], v[2], v[4], alpha ? v[6] : 255), b(v[1], v[3], v[5], alpha ? v[7] : 255);
    if (b.x + b.y + b.z >= a.x + a.y + a.z) return {a, b};
    const auto contract = [](glm::ivec4 c) {
        return glm::ivec4((c.x + c.z) >> 1, (c.y + c.z) >> 1, c.z, c.w);
    };
    return {contract(b), contract(a)};
}

int infilled(const int* grid, int i, int side, const Mode& mode) {
    const int scale = (1024 + side / 2) / (side - 1);
    const int gs = (scale * (i % side) * (mode.width - 1) + 32) >> 6,
              gt = (scale * (i / side) * (mode.height - 1) + 32) >> 6;
    const int fs = gs & 15, ft = gt & 15, first = (gt >> 4) * mode.width + (gs >> 4);
    const int w11 = (fs * ft + 8) >> 4, w10 = ft - w11, w01 = fs - w11, w00 = 16 - fs - ft + w11;
    const auto at = [&](int index) { return grid[std::min(index, mode.width * mode.height - 1)]; };
    return (at(first) * w00 + at(first + 1) * w01 + at(first + mode.width) * w10 +
            at(first + mode.width + 1) * w11 + 8) >>
           4;
}

}  // namespace

void astc_decode_block(const std::array<uint32_t, 4>& block, int side, glm::vec4* texels) {
    const int count = side * side;
    if (field(block, 0, 9) == 0x1fc) {  // a void extent: one colour
        const bool high_range = bit(block, 9);
        const glm::vec4 colour = glm::vec4(field(block, 64, 16), field(block, 80, 16), field(block, 96, 16),
                                           field(block, 112, 16)) /
                                 65535.0f;
        std::fill_n(texels, count, high_range ? glm::vec4(1, 0, 1, 1) : colour);
        return;
    }
    std::fill_n(texels, count, glm::vec4(1, 0, 1, 1));
    const std::optional<Mode> mode = read_mode(block);
    const int endpoint_mode = field(block, 13, 4);
    if (!mode || field(block, 11, 2) != 0) return;
    if (endpoint_mode != 6 && endpoint_mode != 8 && endpoint_mode != 10 && endpoint_mode != 12) return;
    const bool scaled = endpoint_mode == 6 || endpoint_mode == 10, alpha = endpoint_mode >= 10;
    const int grid_count = mode->width * mode->height, weight_count = grid_count * mode->planes;
    const int weight_bits = mode->weights.size_bits(weight_count), channel_bits = mode->planes == 2 ? 2 : 0;
    if (mode->width > side || mode->height > side || weight_count > 64 || weight_bits < 24 ||
        weight_bits > 96)
        return;
    const int values = (scaled ? 4 : 6) + (alpha ? 2 : 0), left = 128 - 17 - channel_bits - weight_bits;
    if ((13 * values + 4) / 5 > left) return;  // less than the smallest range takes
    const Range range = colour_range(left, values);

    std::array<Value, 64> read;
    std::array<int, 8> v{};
    read_sequence(block, 17, values, range, read.data());
    for (size_t i = 0; i < size_t(values); ++i) v[i] = colour_of(read[i], range);
    const Ends ends = endpoints_of(v.data(), scaled, alpha);

    Block mirrored{};
    for (int i = 0; i < 128; ++i) mirrored[size_t(i / 32)] |= bit(block, 127 - i) << (i % 32);
    std::array<std::array<int, 64>, 2> grids{};
    read_sequence(mirrored, 0, weight_count, mode->weights, read.data());
    for (size_t i = 0; i < size_t(weight_count); ++i)
        grids[i % size_t(mode->planes)][i / size_t(mode->planes)] = weight_of(read[i], mode->weights);
    const int second_channel = mode->planes == 2 ? field(block, 126 - weight_bits, 2) : -1;
    for (int i = 0; i < count; ++i) {
        const int weights[2] = {infilled(grids[0].data(), i, side, *mode),
                                infilled(grids[1].data(), i, side, *mode)};
        for (int c = 0; c < 4; ++c) {
            const int w = weights[c == second_channel ? 1 : 0];
            texels[i][c] =
                float((ends.first[c] * 257 * (64 - w) + ends.second[c] * 257 * w + 32) >> 6) / 65535.0f;
        }
    }
}

}  // namespace loam
