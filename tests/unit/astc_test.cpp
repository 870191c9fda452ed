// ASTC as C++: the encoder's packing against the decoder, which is written from the specification's own
// steps; what blocks must hold exactly, bounds on what they may lose, inputs that break naive encoders.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "runtime/texture/astc_decoder.h"
#include "shaders/texture/astc.h"

namespace {

using namespace loam::shared;
using Shown = std::array<vec4, 36>;
struct Square {
    vec4 at[kAstcMaxTexels];
};

uvec4 encoded(const Square& texels, int side, vec3 weights) {
    AstcEncoder encoder{};
    std::copy(std::begin(texels.at), std::end(texels.at), encoder.astc_texels);
    return encoder.astc_encode(side, weights);
}

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr vec4 kMagenta(1, 0, 1, 1);

Shown decoded(uvec4 block, int side) {
    Shown shown;
    shown.fill(vec4(-1));
    loam::astc_decode_block({block.x, block.y, block.z, block.w}, side, shown.data());
    return shown;
}

// Sum of squares over a block, in steps of 255; weights of the colour channels, alpha counts 1.
double error_of(uvec4 block, const Square& texels, int side, vec3 weights = vec3(1)) {
    const Shown shown = decoded(block, side);
    double sum = 0;
    for (int i = 0; i < side * side; ++i) {
        const vec4 d = (shown[size_t(i)] - texels.at[i]) * 255.0f;
        sum += double(dot(d * d, vec4(weights, 1)));
    }
    return sum;
}

float byte_value(std::mt19937& random) {
    return float(random() % 256) / 255.0f;
}
vec4 random_colour(std::mt19937& random, bool opaque = true) {
    const float r = byte_value(random), g = byte_value(random), b = byte_value(random);
    return vec4(r, g, b, opaque ? 1.0f : byte_value(random));
}

class AstcSide : public ::testing::TestWithParam<int> {
  protected:
    int side() const { return GetParam(); }
    int count() const { return side() * side(); }
    int candidates() const { return side() == 4 ? kAstcModes4 : kAstcModes6; }
};
INSTANTIATE_TEST_SUITE_P(Astc, AstcSide, ::testing::Values(4, 6),
                         [](const auto& side) { return "Side" + std::to_string(side.param); });

TEST_P(AstcSide, EveryModeFitsAndDecodesToWhatTheEncoderBelieves) {
    std::mt19937 random(1);
    int contracted = 0, turned = 0, two_planes = 0;
    for (int n = 0; n < 4000; ++n) {
        const AstcMode m = astc_candidate(side(), n % candidates(), n % 3 == 0, n / 7 % 3);
        const int grid = m.width * m.height, planes = astc_weights(m) / grid;
        const int weight_bits = astc_sequence_bits(grid * planes, m.weight),
                  end_bits = astc_sequence_bits(astc_values(m), m.colour);
        ASSERT_LE(17 + (planes - 1) * 2 + weight_bits + end_bits, 128);
        ASSERT_GE(weight_bits, 24);
        ASSERT_LE(weight_bits, 96);
        const vec4 a = random_colour(random, !m.alpha), b = random_colour(random, !m.alpha);
        AstcEnds ends = astc_direct_ends(a, b, m.colour);
        if (!m.scaled && n % 2 == 0) {
            const vec4 near = (b - a) * 0.1f + vec4(0.4f, 0.4f, 0.4f, a.w);
            AstcEnds other =
                astc_direct_ends(astc_spread(near), astc_spread(near + (a - b) * 0.1f), m.colour);
            other.contracted = true;
            if (astc_shown(other, m).rise != 0) ends = other;
        }
        contracted += ends.contracted;
        turned += dot(b - a, vec4(1, 1, 1, 0)) < 0;
        AstcEncoder encoder{};
        for (int g = 0; g < grid * planes; ++g)
            encoder.astc_sequence[g] = int(random() % uint(m.weight.levels));
        std::array<int, 36> weights, second{};
        if (planes == 2)
            for (int i = 0; i < count(); ++i)
                second[size_t(i)] = astc_weight_value(encoder.astc_sequence[2 * i + 1], m.weight);
        two_planes += planes == 2;
        for (int i = 0; i < count(); ++i) weights[size_t(i)] = encoder.astc_texel_weight(i, side(), m);
        const Shown shown = decoded(encoder.astc_finish(m, ends), side());
        const AstcColours colours = astc_shown(ends, m);
        // Turned round, an infilled weight may round to the other neighbour: 1/64 of the segment.
        const float slack = grid == count() ? 1e-4f : 1.0f / 64 + 1e-4f;
        for (int i = 0; i < count(); ++i) {
            vec4 w(float(weights[size_t(i)]) / 64.0f);
            if (planes == 2) w[m.second_plane] = float(second[size_t(i)]) / 64.0f;
            const vec4 d = abs(shown[size_t(i)] - (colours.first + (colours.second - colours.first) * w));
            ASSERT_LT(std::max({d.x, d.y, d.z, d.w}), slack) << n << " texel " << i;
        }
    }
    EXPECT_GT(contracted, 100);
    EXPECT_GT(turned, 100);
    EXPECT_EQ(two_planes > 100, side() == 4);
}

TEST_P(AstcSide, ValuesOfARangeRiseFromEndToEnd) {
    for (int i = 1; i <= 18; ++i) {
        const AstcRange r = astc_range((4 + i % 3) << (i / 3));
        for (int p = 0; p < r.levels; ++p) {
            if (r.levels >= 6) {
                const int value = astc_colour_value(p, r);
                EXPECT_EQ(value, p == 0 ? 0 : p == r.levels - 1 ? 255 : value);
                EXPECT_TRUE(p == 0 || value > astc_colour_value(p - 1, r));
                EXPECT_NEAR(value, p * 255.0 / (r.levels - 1), 3.0) << r.levels;
            }
            const double off = astc_weight_value(p, r) - p * 64.0 / (r.levels - 1);
            EXPECT_TRUE(r.levels > 32 || std::abs(off) < 1.6) << r.levels;  // weights have no more
        }
    }
}

TEST_P(AstcSide, FlatBlocksAreExact) {
    std::mt19937 random(2);
    for (int n = 0; n < 300; ++n) {
        Square texels{};
        const vec4 colour = random_colour(random, n % 2 == 0);
        for (vec4& t : texels.at) t = colour;
        EXPECT_LT(error_of(encoded(texels, side(), vec3(1)), texels, side()), 1e-3);
    }
}

TEST_P(AstcSide, TwoOpaqueColoursAndSingleOutliersAreExact) {
    std::mt19937 random(3);
    for (int n = 0; n < 400; ++n) {
        Square texels{};
        const vec4 a = random_colour(random), b = random_colour(random);
        const int outlier = n / 2 % count();
        for (int i = 0; i < count(); ++i)
            texels.at[i] = (n % 2 == 0 ? i == outlier : random() % 2 == 0) ? b : a;
        EXPECT_LT(error_of(encoded(texels, side(), vec3(1)), texels, side()), 0.01) << n;
    }
}

TEST_P(AstcSide, TwoColoursWithAlphaLoseTheRoundingOfTheEndpointsOnly) {
    std::mt19937 random(4);
    for (int n = 0; n < 400; ++n) {
        Square texels{};
        const vec4 a = random_colour(random, false), b = random_colour(random, false);
        for (int i = 0; i < count(); ++i) texels.at[i] = random() % 2 == 0 ? b : a;
        // The mode of endpoints in 96 levels or more, each half a step (and a rounding) off at most.
        const double bound = 255.0 / 95 / 2 + 1.0;
        EXPECT_LE(error_of(encoded(texels, side(), vec3(1)), texels, side()), count() * 4 * bound * bound)
            << n;
    }
}

TEST_P(AstcSide, AnOutlierOverLittleContrastCostsNoMoreThanTheContrast) {
    std::mt19937 random(5);
    for (int n = 0; n < 300; ++n) {
        Square texels{};
        const vec4 base = random_colour(random) * 0.9f, outlier = random_colour(random);
        for (vec4& t : texels.at) t = vec4(vec3(base) + vec3(random_colour(random)) * 0.05f, 1);
        texels.at[n % count()] = outlier;
        vec3 mean(0);
        for (int i = 0; i < count(); ++i)
            if (i != n % count()) mean += vec3(texels.at[i]) / float(count() - 1);
        // The mean of the others and the outlier as endpoints of 8 bits.
        double bound = count() * 3 * 0.26;
        for (int i = 0; i < count(); ++i) {
            const vec3 d = (vec3(texels.at[i]) - mean) * 255.0f;
            if (i != n % count()) bound += double(dot(d, d));
        }
        // Least squares may settle a tenth beside it.
        EXPECT_LE(error_of(encoded(texels, side(), vec3(1)), texels, side()), bound * 1.1) << n;
    }
}

TEST_P(AstcSide, NeverWorseThanOneColourAndCloseOnALine) {
    std::mt19937 random(6);
    double line = 0;
    for (int n = 0; n < 400; ++n) {
        Square texels{};
        const vec4 a = random_colour(random, n % 2 == 0), b = random_colour(random, n % 2 == 0);
        vec4 mean(0);
        for (int i = 0; i < count(); ++i) {
            const float u = float(i % side() + i / side()) / float(2 * side() - 2);
            texels.at[i] = n % 4 < 2 ? random_colour(random, n % 2 == 0) : mix(a, b, u);
            mean += texels.at[i] / float(count());
        }
        double flat = 0;
        for (int i = 0; i < count(); ++i) {
            const vec4 d = (texels.at[i] - mean) * 255.0f;
            flat += double(dot(d, d));
        }
        const double error = error_of(encoded(texels, side(), vec3(1)), texels, side());
        EXPECT_LE(error, flat * 1.0001 + 0.1);
        if (n % 4 >= 2) line += error / count() / 200;
    }
    std::printf("astc %d: a line of colours loses %.2f\n", side(), line);
    EXPECT_LT(line, side() == 4 ? 24.0 : 60.0) << "mean square of the four channels together";
}

TEST_P(AstcSide, WeightsMoveTheErrorAndAChannelMayWeighNothing) {
    std::mt19937 random(7);
    vec4 even(0), green(0);
    double left = 0, right = 0;
    for (int n = 0; n < 200; ++n) {
        Square texels{};
        for (vec4& t : texels.at) t = random_colour(random);
        const Shown a = decoded(encoded(texels, side(), vec3(1)), side()),
                    b = decoded(encoded(texels, side(), vec3(0.2f, 1, 0.2f)), side()),
                    only_green = decoded(encoded(texels, side(), vec3(0, 1, 0)), side()),
                    nothing = decoded(encoded(texels, side(), vec3(0)), side());
        for (int i = 0; i < count(); ++i) {
            const vec4 da = a[size_t(i)] - texels.at[i], db = b[size_t(i)] - texels.at[i],
                       dg = only_green[size_t(i)] - texels.at[i];
            even += da * da;
            green += db * db;
            left += double(dg.y * dg.y), right += double(db.y * db.y);
            EXPECT_NE(nothing[size_t(i)], kMagenta);
        }
    }
    EXPECT_LE(left, right) << "green alone is not farther than green among others";
    EXPECT_LT(green.y, even.y * 0.7f);
    EXPECT_GT(green.x + green.z, even.x + even.z);
}

TEST_P(AstcSide, WhatIsNoNumberCountsAsZeroAndTheRestIsClamped) {
    std::mt19937 random(8);
    Square bad{}, good{};
    for (int i = 0; i < count(); ++i) {
        bad.at[i] = random_colour(random, false);
        if (i % 3 == 0) bad.at[i].x = i % 2 ? kNotANumber : kInfinity;
        if (i % 3 == 1) bad.at[i].w = i % 2 ? -kInfinity : kNotANumber;
        for (int c = 0; c < 4; ++c)
            good.at[i][c] = std::isnan(bad.at[i][c]) ? 0.0f : std::min(std::max(bad.at[i][c], 0.0f), 1.0f);
    }
    EXPECT_EQ(encoded(bad, side(), vec3(1)), encoded(good, side(), vec3(1)));
    for (int i = 0; i < count(); i += 2) good.at[i].y = 1.0f - good.at[i].y;  // the comparison can fail
    EXPECT_NE(encoded(bad, side(), vec3(1)), encoded(good, side(), vec3(1)));
}

TEST(Astc, AChannelOnItsOwnHasAPlaneOfItsOwn) {
    std::mt19937 random(10);
    double error = 0;
    for (int n = 0; n < 200; ++n) {
        Square texels{};
        for (vec4& t : texels.at) {
            const float level = byte_value(random);
            t = vec4(0.2f + 0.5f * level, byte_value(random), 0.1f + 0.6f * level, 1);
            if (n % 2)
                t = vec4(0.2f + 0.5f * level, 0.3f + 0.2f * level, 0.1f + 0.6f * level, byte_value(random));
        }
        error += error_of(encoded(texels, 4, vec3(1)), texels, 4) / 16 / 200;
    }
    std::printf("astc: two planes lose %.1f\n", error);
    EXPECT_LT(error, 255.0 * 255 / 12 / 9)
        << "a plane of four steps at least; one plane loses several times as much";
}

TEST(AstcDecoder, AnyBitsGiveColoursAndWhatItDoesNotReadIsMagenta) {
    std::mt19937 random(9);
    int magenta = 0;
    for (int n = 0; n < 20000; ++n) {
        const uvec4 block(random(), random(), random(), random());
        const int side = n % 2 ? 4 : 6;
        const Shown shown = decoded(block, side);
        for (int i = 0; i < side * side; ++i)
            for (int c = 0; c < 4; ++c) ASSERT_TRUE(shown[size_t(i)][c] >= 0 && shown[size_t(i)][c] <= 1);
        magenta += shown[0] == kMagenta && shown[size_t(side * side - 1)] == kMagenta;
    }
    EXPECT_GT(magenta, 10000);
    EXPECT_LT(magenta, 20000);
    EXPECT_EQ(decoded(uvec4(0), 4)[3], kMagenta);  // a reserved mode
    EXPECT_EQ(decoded(astc_void_extent(vec4(0.5f)) | uvec4(1u << 9u, 0, 0, 0), 4)[3],
              kMagenta);  // high range
    EXPECT_EQ(decoded(astc_void_extent(vec4(1, 0, 0, 1)), 6)[35], vec4(1, 0, 0, 1));
}

}  // namespace
