// Grounds: the same request gives the same bits, erosion keeps its books, debris comes to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "editor/recipe/erosion.h"
#include "editor/recipe/ground.h"
#include "editor/recipe/ground_statistics.h"
#include "editor/recipe/noise.h"

namespace loam {
namespace {

using recipe::Grid;

Grid rough_ground(int size, float tall_m) {
    Grid g(size);
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i)
            g.at(i, j) =
                tall_m * recipe::fractal(static_cast<float>(i) * 0.06f, static_cast<float>(j) * 0.06f, 5, 5);
    return g;
}

double sum_of(const Grid& g) {
    return std::accumulate(g.v.begin(), g.v.end(), 0.0);
}

float steepest_of(const Grid& g, float spacing) {
    float most = 0;
    for (int j = 0; j < g.size; ++j)
        for (int i = 0; i + 1 < g.size; ++i)
            most = std::max(
                {most, std::fabs(g.at(i, j) - g.at(i + 1, j)), std::fabs(g.at(j, i) - g.at(j, i + 1))});
    return most / spacing;
}

class EveryRecipe : public testing::TestWithParam<const char*> {};

TEST_P(EveryRecipe, IsTheSameForTheSameSeedAndAnotherForAnother) {
    const auto a = make_ground({GetParam(), 100, 7}, {});
    const auto b = make_ground({GetParam(), 100, 7}, {});
    const auto c = make_ground({GetParam(), 100, 8}, {});
    ASSERT_TRUE(a && b && c);
    EXPECT_EQ(a->height_m, b->height_m);
    EXPECT_EQ(a->flow_m2, b->flow_m2);
    EXPECT_EQ(a->deposit_m, b->deposit_m);
    EXPECT_NE(a->height_m, c->height_m);
}

TEST_P(EveryRecipe, IsFiniteAtTinyAndOddSizes) {
    for (const double size_m : {64.0, 65.3, 127.0}) {
        const auto g = make_ground({GetParam(), size_m, 3}, {});
        ASSERT_TRUE(g) << g.message();
        ASSERT_EQ(g->height_m.size(), static_cast<size_t>(g->size) * g->size);
        EXPECT_NEAR((g->size - 1) * g->spacing_m, size_m, g->spacing_m);
        for (const auto* map : {&g->height_m, &g->flow_m2, &g->deposit_m, &g->slope, &g->curvature}) {
            ASSERT_EQ(map->size(), g->height_m.size());
            EXPECT_TRUE(std::all_of(map->begin(), map->end(), [](float v) { return std::isfinite(v); }));
        }
        EXPECT_TRUE(std::all_of(g->deposit_m.begin(), g->deposit_m.end(), [](float v) { return v >= 0; }));
        EXPECT_TRUE(
            std::all_of(g->height_m.begin(), g->height_m.end(), [](float v) { return std::fabs(v) < 9000; }));
    }
}

INSTANTIATE_TEST_SUITE_P(All, EveryRecipe, testing::Values("valley", "ridge", "hills", "dunes", "plain"));

TEST(RecipeGround, UnknownNameIsAnsweredWithTheNamesThereAre) {
    const auto g = make_ground({"moon", 100, 1}, {});
    ASSERT_FALSE(g);
    EXPECT_NE(g.message().find("moon"), std::string::npos);
    for (const RecipeName& n : ground_recipe_names())
        EXPECT_NE(g.message().find(n.name), std::string::npos) << n.name;
}

TEST(RecipeGround, SizesOutsideTheRangeAreRefused) {
    for (const double size_m : {0.0, 63.0, 20000.0, std::nan("")})
        EXPECT_FALSE(make_ground({"plain", size_m, 1}, {}));
}

TEST(RecipeGround, SamplesStayBounded) {
    for (double size_m = 64; size_m <= 16800; size_m *= 1.07)
        EXPECT_LE(std::lround(size_m / recipe_spacing_m(size_m)) + 1, 2101);
    EXPECT_EQ(recipe_spacing_m(4096), 2.0);
    EXPECT_EQ(recipe_spacing_m(16800), 8.0);
}

TEST(RecipeGround, CancelStopsAtTheNextStep) {
    int after = 0;
    bool cancelled = false;
    const auto g = make_ground({"valley", 128, 1}, [&](double share, std::string_view) {
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        if (cancelled) ++after;
        if (share > 0.03) cancelled = true;
        return cancelled ? Going::cancel : Going::on;
    });
    ASSERT_FALSE(g);
    EXPECT_EQ(g.message(), kCancelled);
    EXPECT_EQ(after, 0);
}

TEST(RecipeErosion, EverySampleDrainsToAnOutletAndAreasAddUp) {
    const Grid ground = rough_ground(65, 30);
    const recipe::Drainage d = recipe::route(ground, 2.0, recipe::Outlets::all_edges, 9);
    std::vector<uint8_t> placed(ground.v.size(), 0);
    double out = 0;
    for (const uint32_t c : d.order) {
        const uint32_t r = d.receiver[c];
        EXPECT_TRUE(r == c || placed[r]) << "sample " << c << " comes before the one it drains to";
        placed[c] = 1;
        if (r == c) out += d.area_m2.v[c];
    }
    EXPECT_EQ(std::count(placed.begin(), placed.end(), 1), static_cast<std::ptrdiff_t>(ground.v.size()));
    EXPECT_NEAR(out, 65.0 * 65.0 * 4.0, 1.0);
}

TEST(RecipeErosion, SlidingDebrisKeepsItsMassAndComesToRest) {
    Grid ground = rough_ground(65, 40);
    const double before = sum_of(ground);
    ASSERT_GT(steepest_of(ground, 1), 1.5f);
    recipe::settle(ground, 1.0, 0.6f, 4000);
    EXPECT_NEAR(sum_of(ground), before, 1.0);  // metres in 4,225 samples: rounding
    EXPECT_LT(steepest_of(ground, 1), 0.65f);
}

TEST(RecipeErosion, WeatheringKeepsTheMass) {
    Grid ground = rough_ground(65, 40), debris(65);
    const double before = sum_of(ground);
    recipe::weather(ground, debris, 1.0, {}, 100);
    EXPECT_NEAR(sum_of(ground), before, 1.0);
    EXPECT_GT(sum_of(debris), 1.0);
}

TEST(RecipeErosion, SedimentIsAccountedFor) {
    Grid ground = rough_ground(65, 30), deposit(65);
    const double before = sum_of(ground);
    recipe::SedimentBalance whole;
    for (int s = 0; s < 8; ++s) {
        const recipe::Drainage d = recipe::route(ground, 2.0, recipe::Outlets::all_edges);
        const recipe::SedimentBalance b = recipe::carry_sediment(ground, deposit, d, 2.0, {});
        EXPECT_NEAR(b.eroded_m3, b.deposited_m3 + b.exported_m3, 1e-3 * b.eroded_m3 + 0.01);
        whole.eroded_m3 += b.eroded_m3, whole.deposited_m3 += b.deposited_m3;
    }
    EXPECT_GT(whole.eroded_m3, 0);
    EXPECT_NEAR((sum_of(ground) - before) * 4, whole.deposited_m3 - whole.eroded_m3, 2.0);
}

TEST(RecipeErosion, CreepKeepsTheMassAndTheExtremes) {
    Grid ground = rough_ground(65, 30);
    const double before = sum_of(ground);
    const float high = *std::max_element(ground.v.begin(), ground.v.end());
    recipe::creep(ground, 1.0, 5.0f);
    EXPECT_NEAR(sum_of(ground), before, 0.5);
    EXPECT_LE(*std::max_element(ground.v.begin(), ground.v.end()), high);
}

TEST(RecipeStatistics, APlaneHasOneSlopeAndNoCurvature) {
    ElevationMap map{"plane", 50, 40, 3, 2, {}};
    for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 50; ++i) map.height_m.push_back(static_cast<float>(i * 3 * 0.3 + j * 2 * 0.4));
    const GroundStatistics s = ground_statistics(map, 6.0);
    EXPECT_NEAR(s.slope_deg[2], std::atan(0.5) * 57.29578, 0.6);
    EXPECT_LT(s.curvature[2], 1e-4);
}

}  // namespace
}  // namespace loam
