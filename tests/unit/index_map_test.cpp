#include "runtime/maps/index_map.h"

#include <random>

#include "runtime/maps/tint_blocks.h"
#include "tests/unit/map_fixture.h"

namespace loam {
namespace {

using test::MapFixture;
using test::MapFixtureDesc;

constexpr size_t kPageTexels = size_t(kIndexTexels) * kIndexTexels;
constexpr TexelRect kWhole{0, 0, kIndexTexels, kIndexTexels};
const MapFixtureDesc kGrounds[] = {
    {},
    {.samples_x = 700, .samples_y = 333, .height_spacing_m = 0.3, .index_spacing_m = 0.25},
    {.samples_x = 300, .samples_y = 200, .height_spacing_m = 7.7, .index_spacing_m = 4}};

std::unique_ptr<IndexMap> cpu_map(const Document& document, int slot_count = 60) {
    auto map = IndexMap::create(nullptr, document, {.slot_count = slot_count, .gpu = false});
    EXPECT_TRUE(map.ok());
    return std::move(*map);
}

glm::ivec2 sample_of(const MapPage& page, int x, int y) {
    return glm::ivec2(page.x, page.y) * kIndexPayload + glm::ivec2(x, y) - kIndexBorder;
}

TEST(IndexCompose, ARectangleEqualsTheWholePage) {
    for (const MapFixtureDesc& desc : kGrounds) {
        MapFixture ground(desc);
        for (int i = 0; i < 10; ++i) ground.random_command();
        const auto map = cpu_map(ground.document());
        for (int i = 0; i < 40; ++i) {
            const MapPage page = ground.page(map->map());
            std::vector<IndexTexel> whole(kPageTexels);
            IndexMap::compose(ground.document(), map->map(), page, kWhole, whole);
            std::vector<IndexTexel> pieces = whole;
            const TexelRect rect = ground.rect(kIndexTexels);
            for (int y = rect.y0; y < rect.y1; ++y)
                for (int x = rect.x0; x < rect.x1; ++x) pieces[size_t(y * kIndexTexels + x)].layer = 999;
            IndexMap::compose(ground.document(), map->map(), page, rect, pieces);
            ASSERT_EQ(whole, pieces);
        }
    }
}

TEST(IndexCompose, LevelsArePointSamplesOfTheFinest) {
    for (const MapFixtureDesc& desc : kGrounds) {
        MapFixture ground(desc);
        for (int i = 0; i < 10; ++i) ground.random_command();
        const auto map = cpu_map(ground.document());
        const glm::ivec2 last = ground.document().index_size_texels() - 1;
        for (int i = 0; i < 20; ++i) {
            const MapPage page = ground.page(map->map());
            std::vector<IndexTexel> composed(kPageTexels);
            IndexMap::compose(ground.document(), map->map(), page, kWhole, composed);
            for (int k = 0; k < 40; ++k) {
                const int x = ground.uniform(0, kIndexTexels - 1), y = ground.uniform(0, kIndexTexels - 1);
                const glm::ivec2 s = sample_of(page, x, y) * (1 << page.level);
                if (s.x < 0 || s.y < 0 || s.x > last.x || s.y > last.y) continue;
                const double spacing = map->map().spacing_m(0);
                ASSERT_EQ(map->texel_at(s.x * spacing, s.y * spacing),
                          composed[size_t(y * kIndexTexels + x)]);
            }
        }
    }
}

TEST(IndexMap, PagesAfterAnyHistoryEqualPagesFromNothing) {
    for (const MapFixtureDesc& desc : kGrounds) {
        MapFixture ground(desc, 11);
        const auto map = cpu_map(ground.document());
        uint64_t frame = 0;
        const auto refresh = [&] {
            map->map().for_each_resident(
                [&](const MapPage& page, int, const TexelRect&) { map->request(page, 1); });
            map->update_without_gpu(++frame, 0);
        };
        for (int i = 0; i < 60; ++i) map->request(ground.page(map->map()), 1);
        map->update_without_gpu(++frame, 60);
        for (int i = 0; i < 200; ++i) {
            map->on_dirt(ground.random_command().index);
            if (i % 20 != 19) continue;
            refresh();
            ASSERT_EQ(map->count_stale_pages(ground.document()), 0u) << "after command " << i;
        }
        PaintCommand paint;  // negative control: dirt that is lost shows
        const glm::dvec2 centre = ground.document().bounds().center();
        paint.dabs = {centre};
        paint.radius_m = ground.document().bounds().width();
        paint.tint = glm::dvec3(1, 0, 1);
        ground.apply(paint);
        EXPECT_GT(map->count_stale_pages(ground.document()), 0u);
    }
}

TEST(IndexMap, EverySquareOfTheTextureLiesInOnePage) {
    for (const MapFixtureDesc& desc : kGrounds) {
        MapFixture ground(desc);
        const auto map = cpu_map(ground.document());
        const WorldRect bounds = ground.document().bounds();
        for (int k = -12; k <= 8; ++k) {
            const double side = 64 * std::exp2(k);
            for (int i = 0; i < 200; ++i) {
                const double x = std::floor(ground.real(0, bounds.max_x) / side) * side;
                const double y = std::floor(ground.real(0, bounds.max_y) / side) * side;
                const MapPage page = map->page_for_square(x, y, side);
                ASSERT_TRUE(map->map().exists(page));
                const double size = map->map().page_size_m(page.level);
                if (page == map->map().root() && size < side) continue;  // larger than the whole map
                const double largest = map->map().spacing_m(page.level) * kIndexSquareTexels;
                const WorldRect rect = map->map().page_rect(page);
                ASSERT_LE(rect.min_x, x);
                ASSERT_LE(rect.min_y, y);
                ASSERT_GE(rect.max_x, x + side);
                ASSERT_GE(rect.max_y, y + side);
                ASSERT_TRUE(page.level == 0 || page == map->map().root() ||
                            largest == side);  // no coarser than needed
            }
        }
        EXPECT_TRUE(map->map().exists(map->page_for_square(-1e9, 1e9, 1)));
        EXPECT_TRUE(map->map().exists(map->page_for_square(NAN, NAN, NAN)));
        EXPECT_EQ(map->page_for_square(0, 0, 1e12), map->map().root());
    }
}

// What makes tints of neighbouring pages meet: blocks of the border are the neighbour's own.
TEST(IndexMap, PagesShareTheirTintBlocks) {
    MapFixture ground({.samples_x = 1300, .samples_y = 900, .index_spacing_m = 0.5});
    for (int i = 0; i < 30; ++i) ground.random_command();
    const auto map = cpu_map(ground.document());
    constexpr int kAcross = kIndexTexels / kTintBlockTexels, kBorder = kIndexBorder / kTintBlockTexels;
    const auto blocks_of = [&](const MapPage& page) {
        std::vector<IndexTexel> texels(kPageTexels);
        IndexMap::compose(ground.document(), map->map(), page, kWhole, texels);
        std::vector<glm::uvec2> blocks(size_t(kAcross) * kAcross);
        encode_tint_blocks(texels, kIndexTexels, {0, 0, kAcross, kAcross}, blocks);
        return blocks;
    };
    int tinted = 0;
    for (int level = 0; level < 2; ++level) {
        const auto left = blocks_of({level, 0, 0}), right = blocks_of({level, 1, 0}),
                   above = blocks_of({level, 0, 1});
        const auto at = [](const std::vector<glm::uvec2>& blocks, int x, int y) {
            return blocks[size_t(y) * kAcross + size_t(x)];
        };
        for (int i = 0; i < kAcross; ++i)
            for (int k = 0; k < 2 * kBorder; ++k) {
                const int beside = kAcross - 2 * kBorder + k;
                ASSERT_EQ(at(left, beside, i), at(right, k, i)) << "level " << level;
                ASSERT_EQ(at(left, i, beside), at(above, i, k)) << "level " << level;
                tinted += at(right, k, i).x != 0xffffffff;
            }
    }
    EXPECT_GT(tinted, 0);
}

TEST(TintBlocks, WhatIsExactAndWhatIsLost) {
    std::vector<IndexTexel> texels(64);
    std::vector<glm::uvec2> blocks(4);
    const auto worst = [&] {
        encode_tint_blocks(texels, 8, {0, 0, 2, 2}, blocks);
        double most = 0;
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                const glm::vec3 shown =
                    shown_tint(blocks[size_t(y / 4 * 2 + x / 4)], y % 4 * 4 + x % 4) * 255.0f;
                const IndexTexel& t = texels[size_t(y * 8 + x)];
                for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(double(shown[c]) - t.tint[c]));
            }
        return most;
    };
    EXPECT_EQ(worst(), 0);  // untouched ground is white
    std::mt19937 random(7);
    for (int n = 0; n < 300; ++n) {
        IndexTexel tint;
        for (uint8_t& c : tint.tint) c = uint8_t(random() & 0xff);
        std::fill(texels.begin(), texels.end(), tint);
        EXPECT_LE(worst(), 1.6);
        // A painted edge, a block on either side of it.
        for (int y = 0; y < 8; ++y) std::fill_n(texels.begin() + y * 8 + 4, 4, IndexTexel{});
        EXPECT_LE(worst(), 1.6);
    }
    // A rectangle of blocks leaves the others as they are.
    const std::vector<glm::uvec2> before = blocks;
    std::fill(texels.begin(), texels.end(), IndexTexel{.tint = {1, 2, 3}});
    encode_tint_blocks(texels, 8, tint_blocks_of({5, 1, 6, 2}), blocks);
    EXPECT_EQ(blocks[0], before[0]);
    EXPECT_NE(blocks[1], before[1]);
    EXPECT_EQ(blocks[2], before[2]);
    EXPECT_EQ(blocks[3], before[3]);
    EXPECT_EQ(tint_blocks_of({3, 4, 5, 8}), (TexelRect{0, 1, 2, 2}));
    EXPECT_TRUE(tint_blocks_of({3, 3, 3, 3}).empty());
    // In metres: samples 3 and 4 at 0.5 m are in blocks 0 and 1; at a level of 2 m they are between samples.
    EXPECT_EQ(tint_block_rect({1.5, 2, 1.5, 2}, 0.5), (WorldRect{0, 2, 1.5, 3.5}));
    EXPECT_EQ(tint_block_rect({1.5, 2, 1.5, 2}, 2), (WorldRect{0, 0, 6, 6}));
    // The far corner of 16.8 km at 0.1 m, where a sample's place is rounded.
    const WorldRect far = tint_block_rect({16799.9, 16799.9, 16799.9, 16799.9}, 0.1);
    EXPECT_LE(far.min_x, 16799.6 + 1e-6);
    EXPECT_GE(far.max_x, 16799.9 - 1e-6);
    EXPECT_LE(far.max_x - far.min_x, 0.7 + 1e-6);
}

TEST(IndexMap, TexelUnderAPointSeesEditsAtOnce) {
    MapFixture ground({});
    const auto map = cpu_map(ground.document());
    map->request(map->page_for_square(50, 50, 1), 1);
    map->update_without_gpu(1, 10);
    PaintCommand paint;
    paint.dabs = {{50, 50}};
    paint.radius_m = 3;
    paint.hardness = 1;
    paint.layer = "scree";
    const auto dirt = ground.apply(paint);
    map->on_dirt(dirt.index);
    EXPECT_EQ(map->texel_at(50.1, 49.9).layer, ground.document().layer_index("scree"));
    for (const double x : {-1e9, 0.0, ground.document().bounds().max_x, 1e9, double(INFINITY), double(NAN)})
        EXPECT_LT(map->texel_at(x, -x).layer, 3);
}

}  // namespace
}  // namespace loam
