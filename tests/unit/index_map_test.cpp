#include "runtime/maps/index_map.h"

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
                const WorldRect rect = map->map().page_rect(page);
                ASSERT_LE(rect.min_x, x);
                ASSERT_LE(rect.min_y, y);
                ASSERT_GE(rect.max_x, x + side);
                ASSERT_GE(rect.max_y, y + side);
                ASSERT_TRUE(page.level == 0 || size == side);  // no coarser than needed
            }
        }
        EXPECT_TRUE(map->map().exists(map->page_for_square(-1e9, 1e9, 1)));
        EXPECT_TRUE(map->map().exists(map->page_for_square(NAN, NAN, NAN)));
        EXPECT_EQ(map->page_for_square(0, 0, 1e12), map->map().root());
    }
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
