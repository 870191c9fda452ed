// What layers' textures hold: normals as two numbers, fused albedo, gloss of averaged normals.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "shaders/texture/layer_math.h"

namespace {

using namespace loam::shared;

constexpr double kDegrees = 57.29577951308232;

double angle_deg(vec3 a, vec3 b) {
    return std::atan2(double(length(cross(a, b))), double(dot(a, b))) * kDegrees;
}

float eight_bits(float v) {
    return std::round(std::clamp(v, 0.0f, 1.0f) * 255.0f) / 255.0f;
}

vec3 random_normal(std::mt19937& random, float tilt) {
    std::normal_distribution<float> slope(0, tilt);
    return normalize(vec3(slope(random), slope(random), 1));
}

// --- normals ---

TEST(Hemioct, EveryDirectionComesBack) {
    std::mt19937 random(1);
    for (int i = 0; i < 20000; ++i) {
        const vec3 n = random_normal(random, i % 2 ? 0.3f : 5.0f);
        const vec2 e = layer_encode_hemioct(n);
        ASSERT_LE(std::max(std::abs(e.x), std::abs(e.y)), 1.0f);
        ASSERT_LT(angle_deg(layer_decode_hemioct(e), n), 0.002);
        ASSERT_GT(angle_deg(layer_decode_hemioct(vec2(e.y, e.x)), vec3(n.x, n.y, n.z)) + std::abs(n.y), 1e-7);
    }
}

TEST(Hemioct, TheRimIsTheEdgeOfTheSquare) {
    for (int i = 0; i < 720; ++i) {
        const float a = float(i) * 0.00872664626f;
        const vec3 n(std::cos(a), std::sin(a), 0);
        const vec2 e = layer_encode_hemioct(n);
        EXPECT_NEAR(std::max(std::abs(e.x), std::abs(e.y)), 1.0f, 1e-6f);
        EXPECT_LT(angle_deg(layer_decode_hemioct(e), n), 0.01);
        // Rounded to eight bits it stays above the ground's plane.
        const vec3 stored =
            layer_decode_hemioct(vec2(layer_decode_signed(eight_bits(layer_encode_signed(e.x))),
                                      layer_decode_signed(eight_bits(layer_encode_signed(e.y)))));
        EXPECT_GE(stored.z, 0.0f);
        EXPECT_NEAR(length(stored), 1.0f, 1e-6f);
        EXPECT_LT(angle_deg(stored, n), 0.7);
    }
}

TEST(Hemioct, StraightUpIsExactInEightBits) {
    const vec2 e = layer_encode_hemioct(vec3(0, 0, 1));
    EXPECT_EQ(e, vec2(0));
    EXPECT_EQ(std::lround(layer_encode_signed(0.0f) * 255.0f), 128);
    EXPECT_NEAR(layer_decode_signed(128.0f / 255.0f), 0.0f, 1e-6f);
    EXPECT_EQ(layer_decode_hemioct(vec2(0)), vec3(0, 0, 1));
    EXPECT_EQ(layer_normal_of_xy(vec2(0)), vec3(0, 0, 1));
}

TEST(Hemioct, LengthDoesNotMatterAndNothingIsUp) {
    std::mt19937 random(2);
    for (int i = 0; i < 1000; ++i) {
        const vec3 n = random_normal(random, 1);
        for (const float scale : {1e-6f, 0.3f, 7.0f, 1e6f})
            EXPECT_LT(angle_deg(layer_decode_hemioct(layer_encode_hemioct(n * scale)), n), 0.01);
    }
    EXPECT_EQ(layer_decode_hemioct(layer_encode_hemioct(vec3(0))), vec3(0, 0, 1));
    // x and y beyond the rim lie on it.
    const vec3 rim = layer_normal_of_xy(vec2(0.9f, 0.9f));
    EXPECT_EQ(rim.z, 0.0f);
    EXPECT_NEAR(length(rim), 1.0f, 1e-6f);
}

TEST(Quadratic, ComesBackWithItsSign) {
    for (int i = -1000; i <= 1000; ++i) {
        const float x = float(i) / 1000;
        EXPECT_NEAR(layer_decode_quadratic(layer_encode_quadratic(x)), x, 1e-6f);
    }
    EXPECT_EQ(layer_encode_quadratic(0.0f), 0.0f);
    EXPECT_EQ(layer_encode_quadratic(-1.0f), -1.0f);
}

// The talk's claim: "adds more precision to flat normals".
TEST(Quadratic, AlmostFlatNormalsAreNearerAndSteepOnesAreNot) {
    const auto mean_error = [](float tilt, bool quadratic) {
        std::mt19937 random(3);
        double sum = 0;
        for (int i = 0; i < 5000; ++i) {
            const vec3 n = random_normal(random, tilt);
            vec2 e = layer_encode_hemioct(n);
            if (quadratic) e = vec2(layer_encode_quadratic(e.x), layer_encode_quadratic(e.y));
            e = vec2(layer_decode_signed(eight_bits(layer_encode_signed(e.x))),
                     layer_decode_signed(eight_bits(layer_encode_signed(e.y))));
            if (quadratic) e = vec2(layer_decode_quadratic(e.x), layer_decode_quadratic(e.y));
            sum += angle_deg(layer_decode_hemioct(e), n);
        }
        return sum / 5000;
    };
    EXPECT_LT(mean_error(0.02f, true), 0.5 * mean_error(0.02f, false));
    EXPECT_GT(mean_error(1.0f, true), mean_error(1.0f, false));
}

// --- specular and metalness ---

float worst(AlbedoSpecular split, vec3 albedo, vec3 specular) {
    const vec3 a = abs(split.albedo - albedo), s = abs(split.specular - specular);
    return std::max({a.x, a.y, a.z, s.x, s.y, s.z});
}

TEST(FusedAlbedo, InsulatorsComeBackExactly) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const vec3 albedo(unit(random), unit(random), unit(random));
        const vec3 specular(unit(random) * kInsulatorSpecular);
        FusedAlbedo fused = layer_fuse(albedo, specular);
        EXPECT_LT(worst(layer_split(fused), albedo, specular), 1e-6f);
        EXPECT_LE(fused.metalness, kInsulatorSpecular);
        fused.metalness += 0.1f;  // what does not hold the metalness does not come back
        EXPECT_GT(worst(layer_split(fused), albedo, specular), 0.005f);
    }
}

TEST(FusedAlbedo, MetalsAndGreyMixturesComeBack) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const vec3 metal = vec3(0.4f) + vec3(unit(random), unit(random), unit(random)) * 0.6f;
        EXPECT_LT(worst(layer_split(layer_fuse(vec3(0), metal)), vec3(0), metal), 3e-4f);
        const vec3 grey(unit(random)), shine(unit(random) * (1 - grey.x));
        EXPECT_LT(worst(layer_split(layer_fuse(grey, shine)), grey, shine), 3e-4f);
    }
}

TEST(FusedAlbedo, ColouredMixturesAreBoundedByTheirColour) {
    // One colour for both: each channel errs by at most the difference of the colours.
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(0, 1);
    float largest = 0;
    for (int i = 0; i < 5000; ++i) {
        const vec3 specular(unit(random), unit(random), unit(random));
        const vec3 albedo = (vec3(1) - specular) * vec3(unit(random), unit(random), unit(random));
        const FusedAlbedo fused = layer_fuse(albedo, specular);
        ASSERT_TRUE(fused.metalness >= 0 && fused.metalness <= 1);
        largest = std::max(largest, worst(layer_split(fused), albedo, specular));
    }
    EXPECT_GT(largest, 0.1f);  // the model's limit, not hidden
    EXPECT_LT(largest, 1.0f);
}

TEST(FusedAlbedo, BlackIsNoMetalAndNothingIsInfinite) {
    const FusedAlbedo black = layer_fuse(vec3(0), vec3(0));
    EXPECT_EQ(black.metalness, 0.0f);
    EXPECT_EQ(black.albedo, vec3(0));
    EXPECT_LT(worst(layer_split(black), vec3(0), vec3(0)), 1e-7f);
    const FusedAlbedo mirror = layer_fuse(vec3(0), vec3(1));
    EXPECT_NEAR(mirror.metalness, 1.0f, 1e-3f);
    EXPECT_NEAR(layer_metal_share(1.0f), 1.0f, 1e-6f);
    EXPECT_EQ(layer_metal_share(0.04f), 0.0f);
}

TEST(FusedAlbedo, LightingReflectsTheMetalsOwnColour) {
    const vec3 gold(1.0f, 0.71f, 0.29f);
    const FusedAlbedo lit = layer_lit(layer_fuse(vec3(0), gold));
    EXPECT_LT(worst(layer_reflected(lit), vec3(0), gold), 2e-3f);
    const FusedAlbedo soil = layer_lit(layer_fuse(vec3(0.2f, 0.15f, 0.1f), vec3(0.04f)));
    EXPECT_LT(worst(layer_reflected(soil), vec3(0.2f, 0.15f, 0.1f), vec3(0.04f)), 1e-6f);
}

// --- gloss ---

TEST(Gloss, NoneAndAllComeBack) {
    for (const float gloss : {0.0f, 0.25f, 0.5f, 1.0f})
        EXPECT_NEAR(layer_gloss_of_alpha2(layer_alpha2_of_gloss(gloss)), gloss, 1e-6f);
    EXPECT_EQ(layer_spread_alpha2(1.0f), 0.0f);
    EXPECT_EQ(layer_gloss_of_alpha2(layer_alpha2_of_gloss(0.0f) + 5.0f), 0.0f);
    EXPECT_TRUE(std::isfinite(layer_spread_alpha2(0.0f)));
    EXPECT_EQ(layer_gloss_of_alpha2(layer_spread_alpha2(0.0f)), 0.0f);
}

// Difference of lobes over the hemisphere, weighted by the cosine: 0 … 2.
double lobe_error(const std::vector<vec3>& normals, float alpha, float widened_alpha2) {
    vec3 mean(0);
    for (const vec3& n : normals) mean += n;
    mean = normalize(mean);
    const auto lobe = [](vec3 n, vec3 h, float a2) {
        const float c = dot(n, h);
        if (c <= 0) return 0.0f;
        const float d = c * c * (a2 - 1) + 1;
        return a2 / (3.14159265f * d * d);
    };
    constexpr int kRings = 40, kSpokes = 80;
    double sum = 0;
    for (int r = 0; r < kRings; ++r)
        for (int s = 0; s < kSpokes; ++s) {
            const float t = (float(r) + 0.5f) / kRings * 1.57079633f, p = float(s) / kSpokes * 6.28318531f;
            const vec3 h(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
            float full = 0;
            for (const vec3& n : normals) full += lobe(n, h, alpha * alpha);
            sum += double(std::abs(full / float(normals.size()) - lobe(mean, h, widened_alpha2)) *
                          std::sin(t) * std::max(dot(mean, h), 0.0f));
        }
    return sum * (1.57079633 / kRings) * (6.28318531 / kSpokes);
}

TEST(Gloss, TheLengthOfTheMeanPredictsTheLobeBetterThanMomentsOfSlope) {
    std::mt19937 random(7);
    double by_length = 0, by_moments = 0, by_nothing = 0;
    for (const float tilt : {0.15f, 0.3f, 0.6f})
        for (const float alpha : {0.1f, 0.3f, 0.6f}) {
            std::vector<vec3> normals;
            vec3 mean(0);
            double variance = 0;
            for (int i = 0; i < 64; ++i) {
                normals.push_back(random_normal(random, tilt));
                const vec3 n = normals.back();
                mean += n / 64.0f;
                variance += double(n.x * n.x + n.y * n.y) / double(n.z * n.z) / 64;
            }
            variance -= double(mean.x * mean.x + mean.y * mean.y) / double(mean.z * mean.z);
            const float plain = alpha * alpha;
            by_nothing += lobe_error(normals, alpha, plain);
            by_length +=
                lobe_error(normals, alpha, std::min(1.0f, plain + layer_spread_alpha2(length(mean))));
            by_moments += lobe_error(normals, alpha, std::min(1.0f, plain + float(variance)));
        }
    EXPECT_LT(by_length, by_moments);
    EXPECT_LT(by_length, 0.6 * by_nothing);
    RecordProperty("length", std::to_string(by_length));
    RecordProperty("moments", std::to_string(by_moments));
}

}  // namespace
