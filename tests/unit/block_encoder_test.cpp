// The block encoders as C++: what they must hold exactly, bounds on what they may lose, inputs that break
// naive ones.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "shaders/texture/bc1_fine.h"
#include "shaders/texture/bc3.h"

namespace {

using namespace loam::shared;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

vec3 from_565(uint c) {
    return bc1_unpack565(c);
}

TEST(Bc1, FlatColoursOf565AreExact) {
    std::mt19937 random(3);
    for (int n = 0; n < 500; ++n) {
        const vec3 color = from_565(random() & 0xffff);
        vec3 texels[16];
        for (vec3& t : texels) t = color;
        const uvec2 block = bc1_encode(texels, vec3(1));
        for (int i = 0; i < 16; ++i) EXPECT_LT(glm::length(bc1_decode(block, i) - color), 1e-3f);
    }
}

TEST(Bc1, AnyFlatColourIsWithinAThirdOfAStep) {
    std::mt19937 random(4);
    for (int n = 0; n < 2000; ++n) {
        const vec3 color = vec3(float(random() % 256), float(random() % 256), float(random() % 256)) / 255.0f;
        vec3 texels[16];
        for (vec3& t : texels) t = color;
        const vec3 error = glm::abs(bc1_decode(bc1_encode(texels, vec3(1)), 5) - color) * 255.0f;
        EXPECT_LE(error.x, 1.9f);
        EXPECT_LE(error.y, 1.2f);
        EXPECT_LE(error.z, 1.9f);
    }
}

TEST(Bc1, TwoColoursAreExact) {
    std::mt19937 random(5);
    for (int n = 0; n < 500; ++n) {
        const vec3 a = from_565(random() & 0xffff), b = from_565(random() & 0xffff);
        vec3 texels[16];
        const uint32_t pattern = uint32_t(random());
        for (int i = 0; i < 16; ++i) texels[i] = pattern >> i & 1 ? a : b;
        const uvec2 block = bc1_encode(texels, vec3(1));
        for (int i = 0; i < 16; ++i) EXPECT_LT(glm::length(bc1_decode(block, i) - texels[i]), 1e-3f);
    }
}

TEST(Bc1, FourColourModeUnlessEqual) {
    std::mt19937 random(6);
    for (int n = 0; n < 2000; ++n) {
        vec3 texels[16];
        for (vec3& t : texels)
            t = vec3(float(random() % 256), float(random() % 256), float(random() % 256)) / 255.0f;
        const uvec2 block = bc1_encode(texels, vec3(1));
        const uint c0 = block.x & 0xffff, c1 = block.x >> 16;
        EXPECT_TRUE(c0 > c1 || (c0 == c1 && block.y == 0));
    }
}

// Ground-like: three octaves of smooth noise in brightness, a little hue.
TEST(Bc1, AGroundPageIsAbove41Decibels) {
    std::mt19937 random(7);
    constexpr int kSide = 128;
    std::vector<vec3> page(kSide * kSide);
    std::vector<float> grid(65 * 65);
    for (float& g : grid) g = float(random() % 1000) / 1000.0f;
    const auto noise = [&](float x, float y) {
        const int ix = int(x), iy = int(y);
        const float u = x - float(ix), v = y - float(iy);
        const auto at = [&](int i, int j) { return grid[size_t(j % 65) * 65 + size_t(i % 65)]; };
        return (at(ix, iy) * (1 - u) + at(ix + 1, iy) * u) * (1 - v) +
               (at(ix, iy + 1) * (1 - u) + at(ix + 1, iy + 1) * u) * v;
    };
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const float n = 0.5f * noise(float(x) / 16, float(y) / 16) +
                            0.3f * noise(float(x) / 5, float(y) / 5) +
                            0.2f * noise(float(x) / 2, float(y) / 2);
            const float hue = noise(float(x) / 9 + 20, float(y) / 9 + 7);
            page[size_t(y * kSide + x)] = glm::clamp(
                vec3(0.15f + 0.5f * n, 0.12f + 0.45f * n + 0.08f * hue, 0.1f + 0.3f * n), 0.0f, 1.0f);
        }
    double error = 0;
    for (int by = 0; by < kSide; by += 4)
        for (int bx = 0; bx < kSide; bx += 4) {
            vec3 texels[16];
            for (int i = 0; i < 16; ++i) texels[i] = page[size_t((by + i / 4) * kSide + bx + i % 4)];
            const uvec2 block = bc1_encode(texels, vec3(1));
            for (int i = 0; i < 16; ++i) {
                const vec3 d = bc1_decode(block, i) - texels[i];
                error += glm::dot(d, d);
            }
        }
    const double psnr = -10.0 * std::log10(error / (3.0 * kSide * kSide));
    RecordProperty("psnr", std::to_string(psnr));
    std::printf("bc1 ground page: %.2f dB\n", psnr);
    EXPECT_GT(psnr, 41.0);
}

// Weighted sum of squares over a block, in steps of 255.
double bc1_error(uvec2 block, const vec3 (&texels)[16], vec3 weights) {
    double sum = 0;
    for (int i = 0; i < 16; ++i) {
        const vec3 d = (bc1_decode(block, i) - texels[i]) * 255.0f;
        sum += double(dot(d * d, weights));
    }
    return sum;
}

vec3 random_colour(std::mt19937& random) {
    return vec3(float(random() % 256), float(random() % 256), float(random() % 256)) / 255.0f;
}

TEST(Bc1, TwoColoursOfEightBitsAndOutliersLoseTheRoundingOfTheEndpointsOnly) {
    std::mt19937 random(21);
    // Half the largest step of five and of six bits: attempted with both colours as endpoints, so never
    // worse.
    const double five = 4.51, six = 2.51, bound = 16 * (five * five + six * six + five * five);
    double live = 0, fine = 0;
    for (int n = 0; n < 640; ++n) {
        const vec3 a = random_colour(random), b = random_colour(random);
        vec3 texels[16];
        const uint pattern = n % 2 == 0 ? uint(random()) : 1u << (n / 2 % 16);
        for (int i = 0; i < 16; ++i) texels[i] = pattern >> i & 1u ? a : b;
        const double error = bc1_error(bc1_encode(texels, vec3(1)), texels, vec3(1));
        EXPECT_LE(error, bound);
        live += error;
        fine += bc1_error(bc1_encode_fine(texels, vec3(1)), texels, vec3(1));
    }
    std::printf("bc1 two colours: mean square %.2f live, %.2f fine\n", live / 640 / 48, fine / 640 / 48);
    EXPECT_LT(fine, live * 0.9);
}

TEST(Bc1, AnOutlierOverLittleContrastCostsNoMoreThanTheContrast) {
    std::mt19937 random(22);
    for (int n = 0; n < 640; ++n) {
        const vec3 base = random_colour(random) * 0.9f, outlier = random_colour(random);
        vec3 texels[16], mean(0);
        for (vec3& t : texels) t = base + random_colour(random) * 0.05f;
        texels[n % 16] = outlier;
        for (int i = 0; i < 16; ++i)
            if (i != n % 16) mean += texels[i] * (1.0f / 15.0f);
        // The mean of the others and the outlier as endpoints, each rounded.
        double bound = 16 * (4.51 * 4.51 * 2 + 2.51 * 2.51);
        for (int i = 0; i < 16; ++i) {
            const vec3 d = (texels[i] - mean) * 255.0f;
            if (i != n % 16) bound += double(dot(d, d));
        }
        EXPECT_LE(bc1_error(bc1_encode(texels, vec3(1)), texels, vec3(1)), bound);
    }
}

TEST(Bc1, FineIsNeverWorseThanLiveAndAlsoOfFourColours) {
    std::mt19937 random(23);
    double live = 0, fine = 0;
    for (int n = 0; n < 600; ++n) {
        const vec3 a = random_colour(random), b = random_colour(random), weights(0.7f, 1, 0.4f);
        vec3 texels[16];
        for (vec3& t : texels) {
            const float u = float(random() % 1000) / 999.0f;
            t = n % 3 == 0 ? random_colour(random)
                           : mix(a, b, u) + random_colour(random) * (n % 3 == 1 ? 0.1f : 0.02f);
            t = block_unit3(t);
        }
        const uvec2 block = bc1_encode_fine(texels, weights);
        const double live_error = bc1_error(bc1_encode(texels, weights), texels, weights);
        const double fine_error = bc1_error(block, texels, weights);
        EXPECT_LE(fine_error, live_error * 1.0001 + 1e-3);
        live += live_error;
        fine += fine_error;
        const uint c0 = block.x & 0xffffu, c1 = block.x >> 16u;
        EXPECT_TRUE(c0 > c1 || (c0 == c1 && block.y == 0));
    }
    EXPECT_LT(fine, live * 0.99);
}

TEST(Bc1, WeightsMoveTheErrorToTheOtherChannels) {
    std::mt19937 random(24);
    vec3 even(0), green(0);
    for (int n = 0; n < 300; ++n) {
        vec3 texels[16];
        for (vec3& t : texels) t = random_colour(random);
        const uvec2 a = bc1_encode(texels, vec3(1)), b = bc1_encode(texels, vec3(0.2f, 1, 0.2f));
        for (int i = 0; i < 16; ++i) {
            const vec3 da = bc1_decode(a, i) - texels[i], db = bc1_decode(b, i) - texels[i];
            even += da * da;
            green += db * db;
        }
    }
    EXPECT_LT(green.y, even.y * 0.7f);
    EXPECT_GT(green.x + green.z, even.x + even.z);
}

// A normal's X in green between two channels that say something else.
TEST(Bc1, AChannelThatWeighsNothingCostsTheOthersNothing) {
    std::mt19937 random(26);
    double alone = 0, among = 0, of_grey = 0;
    for (int n = 0; n < 300; ++n) {
        vec3 texels[16], grey[16];
        for (int i = 0; i < 16; ++i) {
            texels[i] = random_colour(random);
            grey[i] = vec3(texels[i].y);
        }
        for (const bool fine : {false, true}) {
            const auto encode = [&](const vec3(&t)[16], vec3 weights) {
                return fine ? bc1_encode_fine(t, weights) : bc1_encode(t, weights);
            };
            alone += bc1_error(encode(texels, vec3(0, 1, 0)), texels, vec3(0, 1, 0));
            among += bc1_error(encode(texels, vec3(1)), texels, vec3(0, 1, 0));
            of_grey += bc1_error(encode(grey, vec3(0, 1, 0)), grey, vec3(0, 1, 0));
            const uvec2 nothing = encode(texels, vec3(0));
            EXPECT_TRUE((nothing.x & 0xffffu) > nothing.x >> 16u || nothing.y == 0)
                << "still of four colours";
        }
    }
    EXPECT_NEAR(alone, of_grey, of_grey * 0.02) << "as if the others were not there";
    EXPECT_LT(alone, among * 0.25);
}

TEST(Bc1, WhatIsNoNumberCountsAsZeroAndTheRestIsClamped) {
    std::mt19937 random(25);
    vec3 bad[16], good[16];
    for (int i = 0; i < 16; ++i) {
        bad[i] = random_colour(random);
        if (i % 3 == 0) bad[i].x = i % 2 ? kNotANumber : kInfinity;
        if (i % 3 == 1) bad[i].y = i % 2 ? -kInfinity : 7.0f;
        good[i] = vec3(std::isnan(bad[i].x) ? 0.0f : bad[i].x, bad[i].y, bad[i].z);
        good[i] = glm::clamp(good[i], 0.0f, 1.0f);
    }
    EXPECT_EQ(bc1_encode(bad, vec3(1)), bc1_encode(good, vec3(1)));
    EXPECT_EQ(bc1_encode_fine(bad, vec3(1)), bc1_encode_fine(good, vec3(1)));
    good[0].y = 1.0f - good[0].y;  // the comparison can fail
    EXPECT_NE(bc1_encode(bad, vec3(1)), bc1_encode(good, vec3(1)));
}

// Sum of squares over a block, in steps of 255.
double bc4_error(uvec2 block, const float (&texels)[16]) {
    double sum = 0;
    for (int i = 0; i < 16; ++i) {
        const double d = (double(bc4_decode(block, i)) - double(texels[i])) * 255.0;
        sum += d * d;
    }
    return sum;
}

// The best of all endpoints of both modes, each texel at its nearest value.
double bc4_least_error(const float (&texels)[16]) {
    double least = 1e30;
    for (uint a = 0; a < 256; ++a)
        for (uint b = 0; b < 256; ++b) {
            float values[8];
            for (uint k = 0; k < 8; ++k)  // eight texels of a block that has each index once
                values[k] = bc4_decode(uvec2(a | b << 8u | 0xfac688u << 16u, 0xfac688u >> 16u), int(k));
            double sum = 0;
            for (const float t : texels) {
                double nearest = 1e30;
                for (const float v : values) nearest = std::min(nearest, std::abs(double(v) - double(t)));
                sum += nearest * nearest * 255.0 * 255.0;
            }
            least = std::min(least, sum);
        }
    return least;
}

TEST(Bc4, FlatTwoValueAndOutlierBlocksAreExact) {
    std::mt19937 random(11);
    for (int n = 0; n < 4000; ++n) {
        const float a = float(random() % 256) / 255.0f, b = float(random() % 256) / 255.0f;
        float texels[16];
        const uint pattern = n % 3 == 0 ? 0u : n % 3 == 1 ? 1u << (random() % 16) : uint(random());
        for (int i = 0; i < 16; ++i) texels[i] = pattern >> i & 1u ? a : b;
        EXPECT_LT(bc4_error(bc4_encode(texels), texels), 1e-6);
    }
}

TEST(Bc4, NeverFartherThanTheEvenDivisionOfTheRange) {
    std::mt19937 random(12);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int n = 0; n < 4000; ++n) {
        const float base = unit(random), range = unit(random) * unit(random) * (1.0f - base);
        float texels[16];
        for (float& t : texels) t = base + range * unit(random);
        // Each texel within half a seventh, and the endpoints' rounding.
        const double bound = double(range) * 255.0 / 14.0 + 0.51;
        EXPECT_LE(bc4_error(bc4_encode(texels), texels), 16 * bound * bound);
    }
}

TEST(Bc4, NearTheBestOfAllEndpoints) {
    std::mt19937 random(13);
    std::uniform_real_distribution<float> unit(0, 1);
    double ours = 0, least = 0, unrefined = 0;
    for (int n = 0; n < 60; ++n) {
        float texels[16];
        const float base = unit(random) * 0.8f, range = 0.2f * unit(random);
        for (float& t : texels) t = base + range * unit(random);
        if (n % 3 == 1) texels[random() % 16] = unit(random);  // an outlier over little contrast
        if (n % 3 == 2) texels[random() % 16] = float(random() % 2);
        float values[16];
        for (int i = 0; i < 16; ++i) values[i] = texels[i] * 255.0f;
        float low = 255, high = 0;
        for (const float v : values) low = std::min(low, v), high = std::max(high, v);
        unrefined += double(bc4_try(values, low, high, 7.0f).error);
        ours += bc4_error(bc4_encode(texels), texels);
        least += bc4_least_error(texels);
    }
    std::printf("bc4: %.2f times the least error, %.2f without refinement\n", ours / least,
                unrefined / least);
    EXPECT_GE(ours, least * 0.999);
    EXPECT_LT(ours, least * 1.25);
    EXPECT_GT(unrefined, least * 1.25) << "the bound tells nothing";
}

TEST(Bc4, LimitsBesideMidValuesUseTheModeOfSix) {
    float texels[16];
    for (int i = 0; i < 16; ++i) texels[i] = i % 4 == 0 ? 0.0f : i % 4 == 1 ? 1.0f : float(100 + i) / 255.0f;
    const uvec2 block = bc4_encode(texels);
    EXPECT_LE(block.x & 255u, block.x >> 8u & 255u);
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(bc4_decode(block, i), texels[i], 2.0f / 255.0f);
}

TEST(Bc4, WhatIsNoNumberCountsAsZeroAndTheRestIsClamped) {
    const float bad[16] = {kNotANumber, kInfinity, -kInfinity, 2, -3, 1e30f, -1e-30f, 0.5f,
                           kNotANumber, 0.5f,      0.25f,      1, 0,  0.5f,  0.25f,   0.25f};
    float good[16];
    for (int i = 0; i < 16; ++i) good[i] = std::isnan(bad[i]) ? 0.0f : std::min(std::max(bad[i], 0.0f), 1.0f);
    EXPECT_EQ(bc4_encode(bad), bc4_encode(good));
    good[7] = 0.1f;  // the comparison can fail
    EXPECT_NE(bc4_encode(bad), bc4_encode(good));
}

TEST(Bc3, IsABc4BlockAndABc1BlockOfFourColours) {
    std::mt19937 random(14);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int n = 0; n < 1000; ++n) {
        vec4 texels[16];
        vec3 colours[16];
        float alphas[16];
        const vec4 flat(unit(random), unit(random), unit(random), unit(random));
        for (int i = 0; i < 16; ++i) {
            texels[i] = n % 4 == 0 ? flat : vec4(unit(random), unit(random), unit(random), unit(random));
            colours[i] = vec3(texels[i]);
            alphas[i] = texels[i].w;
        }
        const uvec4 block = bc3_encode(texels, vec3(1, 2, 1));
        EXPECT_EQ(uvec2(block.x, block.y), bc4_encode(alphas));
        EXPECT_EQ(uvec2(block.z, block.w), bc1_encode(colours, vec3(1, 2, 1)));
        const uint c0 = block.z & 0xffffu, c1 = block.z >> 16u;
        EXPECT_TRUE(c0 > c1 || (c0 == c1 && block.w == 0));
        EXPECT_EQ(bc3_decode(block, 9).w, bc4_decode(uvec2(block.x, block.y), 9));
    }
}

}  // namespace
