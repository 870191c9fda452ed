// Layers and the index map: tileable, bounded, deterministic.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "editor/recipe/index_map.h"
#include "editor/recipe/layers.h"

namespace loam {
namespace {

constexpr int kSize = 128;

class EveryLayer : public testing::TestWithParam<int> {
  protected:
    const LayerRecipe& recipe() const { return layer_recipe_names()[static_cast<size_t>(GetParam())]; }
};

// Mean absolute step between neighbours over a pair of columns (or rows) and its wrapped next.
double step_across(const std::vector<uint8_t>& texels, int channel, int line, bool columns) {
    double sum = 0;
    const int next = (line + 1) % kSize;
    for (int k = 0; k < kSize; ++k) {
        const int a = columns ? k * kSize + line : line * kSize + k,
                  b = columns ? k * kSize + next : next * kSize + k;
        sum += std::abs(texels[static_cast<size_t>(a) * 4 + channel] -
                        texels[static_cast<size_t>(b) * 4 + channel]);
    }
    return sum / kSize;
}

TEST_P(EveryLayer, ItsSeamIsLikeItsInterior) {
    const auto t = make_layer(recipe().name, 1, kSize);
    ASSERT_TRUE(t) << t.message();
    for (const auto* texture : {&t->albedo_reveal[0], &t->normal_gloss_occlusion[0]})
        for (int channel = 0; channel < 4; ++channel)
            for (const bool columns : {true, false}) {
                double mean = 0, square = 0;
                for (int line = 0; line < kSize - 1; ++line) {
                    const double s = step_across(*texture, channel, line, columns);
                    mean += s / (kSize - 1), square += s * s / (kSize - 1);
                }
                const double deviation = std::sqrt(std::max(0.0, square - mean * mean));
                EXPECT_LT(step_across(*texture, channel, kSize - 1, columns), mean + 5 * deviation + 1)
                    << recipe().name << " channel " << channel << (columns ? " columns" : " rows");
            }
}

TEST_P(EveryLayer, IsTheSameForTheSameSeedAndAnotherForAnother) {
    const auto a = make_layer(recipe().name, 4, kSize), b = make_layer(recipe().name, 4, kSize),
               c = make_layer(recipe().name, 5, kSize);
    ASSERT_TRUE(a && b && c);
    EXPECT_EQ(a->albedo_reveal, b->albedo_reveal);
    EXPECT_EQ(a->normal_gloss_occlusion, b->normal_gloss_occlusion);
    EXPECT_NE(a->albedo_reveal, c->albedo_reveal);
}

TEST_P(EveryLayer, HasAPlausibleMeanAlbedoAndUsesItsReveal) {
    const auto t = make_layer(recipe().name, 1, kSize);
    ASSERT_TRUE(t);
    double green = 0, reveal = 0, reveal_square = 0, nx = 0;
    for (int k = 0; k < kSize * kSize; ++k) {
        const double g = t->albedo_reveal[0][static_cast<size_t>(k) * 4 + 1] / 255.0,
                     r = t->albedo_reveal[0][static_cast<size_t>(k) * 4 + 3];
        green += std::pow((g + 0.055) / 1.055, 2.4) / (kSize * kSize);
        reveal += r / (kSize * kSize), reveal_square += r * r / (kSize * kSize);
        nx += t->normal_gloss_occlusion[0][static_cast<size_t>(k) * 4] / (255.0 * kSize * kSize);
    }
    EXPECT_GT(green, 0.03);
    EXPECT_LT(green, 0.9);
    EXPECT_GT(std::sqrt(reveal_square - reveal * reveal), 20) << "reveal hardly varies";
    EXPECT_NEAR(nx, 0.5, 0.02);  // a tile that repeats has no slope on average
    EXPECT_EQ(t->mip_count, 8);
}

INSTANTIATE_TEST_SUITE_P(All, EveryLayer, testing::Range(0, 8));

TEST(RecipeLayers, UnknownNameIsAnsweredWithTheNamesThereAre) {
    const auto t = make_layer("lava", 1, kSize);
    ASSERT_FALSE(t);
    for (const LayerRecipe& n : layer_recipe_names())
        EXPECT_NE(t.message().find(n.name), std::string::npos) << n.name;
    EXPECT_FALSE(make_layer("grass", 1, 100));
}

TEST(RecipeIndexMap, ValuesAreLayersTintIsNearWhiteAndStripsDoNotMatter) {
    for (const char* name : {"valley", "dunes", "hills"}) {
        const auto ground = make_ground({name, 128, 2}, {});
        ASSERT_TRUE(ground);
        const IndexRequest request{.maps = &*ground,
                                   .climate = recipe_climate(name),
                                   .seed = 2,
                                   .spacing_m = 0.5,
                                   .width = 257,
                                   .height = 257};
        const IndexPainter painter(request);
        std::vector<IndexTexel> whole(257 * 257), strips(257 * 257);
        painter.paint_rows(0, 257, whole.data());
        for (int row = 0; row < 257; row += 31)
            painter.paint_rows(row, std::min(31, 257 - row), &strips[static_cast<size_t>(row) * 257]);
        EXPECT_EQ(whole, strips);
        for (const IndexTexel& t : whole) {
            ASSERT_LT(t.layer, layer_recipe_names().size());
            for (const uint8_t c : t.tint) ASSERT_GE(c, 204);
        }
    }
}

TEST(RecipeIndexMap, SpacingIsAPowerOfTwoAndKeepsTheMapBounded) {
    for (double size_m = 64; size_m <= 16800; size_m *= 1.09) {
        const double s = recipe_index_spacing_m(size_m);
        EXPECT_EQ(std::exp2(std::round(std::log2(s))), s);
        EXPECT_LE(size_m / s, 4200);
    }
    EXPECT_EQ(recipe_index_spacing_m(4096), 1.0);
}

}  // namespace
}  // namespace loam
