// Mathematics shared with the shaders: one material per vertex, page placement.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "runtime/texture/composer.h"
#include "shaders/texture/bc1.h"
#include "shaders/texture/ompv.h"

namespace {

using namespace loam;
using namespace loam::shared;

TEST(Ompv, EveryCornerIsVisitedOnceInAscendingOrder) {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        const uvec4 layers(random() % 5, random() % 5, random() % 5, random() % 5);
        const vec2 fraction(float(random() % 1000) / 1000.0f, float(random() % 1000) / 1000.0f);
        const vec4 weights = ompv_weights(fraction);
        EXPECT_NEAR(ompv_sum(weights), 1.0f, 1e-6f);
        float sum = 0;
        uint from = 0, last = 0;
        int visits = 0;
        for (uint layer = ompv_next(layers, weights, 0); layer != kNoLayer;
             layer = ompv_next(layers, weights, from)) {
            if (visits > 0) {
                EXPECT_GT(layer, last);
            }
            last = layer;
            from = layer + 1;
            sum += ompv_sum(ompv_share(layers, weights, layer));
            ASSERT_LE(++visits, 4);
        }
        EXPECT_NEAR(sum, 1.0f, 1e-6f);
    }
}

TEST(Ompv, AnExactVertexShowsItsOwnLayerOnly) {
    const uvec4 layers(7, 2, 5, 1);
    const vec4 weights = ompv_weights(vec2(0, 0));
    EXPECT_EQ(ompv_next(layers, weights, 0), 7u);
    EXPECT_EQ(ompv_next(layers, weights, 8), kNoLayer);
}

TEST(Ompv, FourDifferentCornersAreFourLayers) {
    const uvec4 layers(4, 3, 2, 1);
    const vec4 weights = ompv_weights(vec2(0.25f, 0.5f));
    uint from = 0;
    for (uint expected = 1; expected <= 4; ++expected) {
        EXPECT_EQ(ompv_next(layers, weights, from), expected);
        from = expected + 1;
    }
    EXPECT_FLOAT_EQ(ompv_sum(ompv_share(layers, weights, 4)), 0.375f);
    EXPECT_FLOAT_EQ(ompv_sum(ompv_share(layers, weights, 1)), 0.125f);
}

TEST(Ompv, OneLayerGivesTheBitsOfTheMergedOne) {
    std::mt19937 random(2);
    for (int i = 0; i < 1000; ++i) {
        const vec4 weights =
            ompv_weights(vec2(float(random() % 997) / 997.0f, float(random() % 997) / 997.0f));
        const vec4 share = ompv_share(uvec4(3), weights, 3);
        const vec3 t0(0.3f, 1, 0.5f), t1(0.7f, 0.1f, 0.5f), t2(1), t3(0);
        EXPECT_EQ(ompv_tint(share, t0, t1, t2, t3), ompv_tint(weights, t0, t1, t2, t3));
    }
}

TEST(Ompv, CoverIsMonotoneFromNothingToAll) {
    for (int r = 0; r <= 20; ++r) {
        const float reveal = float(r) / 20.0f;
        EXPECT_EQ(ompv_cover(0.0f, reveal), 0.0f);
        EXPECT_EQ(ompv_cover(1.0f, reveal), 1.0f);
        float last = 0;
        for (int a = 0; a <= 100; ++a) {
            const float cover = ompv_cover(float(a) / 100.0f, reveal);
            EXPECT_GE(cover, last);
            EXPECT_GE(ompv_cover(float(a) / 100.0f, std::min(1.0f, reveal + 0.05f)), cover);
            last = cover;
        }
    }
}

TEST(Ompv, TintDecodingIsNearTheStandardCurve) {
    for (int i = 0; i <= 255; ++i) {
        const float s = float(i) / 255.0f;
        const float exact = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
        EXPECT_NEAR(ompv_decode_tint(vec3(s)).x, exact, 0.003f);
    }
}

TEST(PageEncoding, AFlatNormalIsExactAlsoInSixBits) {
    const float encoded = std::round(page_encode_normal(0.0f) * 255.0f);
    EXPECT_EQ(encoded, 130.0f);
    EXPECT_NEAR(page_decode_normal(encoded / 255.0f), 0.0f, 1e-6f);
    EXPECT_EQ(bc1_unpack565(bc1_pack565(vec3(0, encoded / 255.0f, 0))).y * 255.0f, 130.0f);
}

TEST(LayerPlace, PrecisionHoldsAtTheFarCorner) {
    const double tile_m = 1.7, corner_m = 16'383.0;
    const LayerPlace place =
        Composer::layer_place(corner_m, corner_m, 1.0, 1.0 / kPagePayload, tile_m, 1024, 16.0);
    const double exact = corner_m / tile_m - std::floor(corner_m / tile_m);
    EXPECT_NEAR(place.offset.x, exact, 1e-6);
    // A quarter of a layer texel anywhere in the page.
    const float uv = place.offset.x + 0.987f * place.scale;
    EXPECT_NEAR(uv, exact + 0.987 / tile_m, 0.25 / 1024);
}

}  // namespace
