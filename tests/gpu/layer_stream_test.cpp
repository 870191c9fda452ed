// Layers that do not all fit their memory: pages are those that all layers give, once they have come.
#include <fmt/format.h>
#include <map>

#include <gtest/gtest.h>

#include "tests/gpu/texture_world.h"

namespace loam::test {
namespace {

using LayerStreamTest = gpu::GpuTest;

constexpr WorldLayers kAll{.texels = 256};
constexpr WorldLayers kFew{.texels = 256, .budget_bytes = 11u << 20};
constexpr int kLayers = 24;

// Patches of 24 layers, and decals of others: together more than there is room for.
void paint_patches(World& w, bool decals = true) {
    for (int i = 0; i < kLayers; ++i) {
        const double x_m = 48 + 12.0 * (i % 6), y_m = 64 + 12.0 * double(i / 6);
        w.on_dirt(need(w.document().apply(
            {.body = PaintCommand{.dabs = {{x_m, y_m}},
                                  .radius_m = 5,
                                  .layer = w.document().settings().layers[size_t(i)].name}})));
    }
    if (!decals) return;
    TerrainDecal decal{.x_m = 85, .y_m = 97, .half_m = {1, 1}};
    decal.material.layer = "layer 20";
    decal.material.tile_m = 1;
    w.on_dirt(need(w.document().apply({.body = AddOperatorCommand{.shape = decal}})));
}

std::vector<PageId> pages_to_want(const World& w) {
    std::vector<PageId> pages;
    for (int i = 0; i < 6; ++i) {
        pages.push_back({{true, 1, 1}, 6, 20 + i % 3, 31 + i / 3});
        pages.push_back({{true, 1, 1}, 3, 2 + i % 3, 3 + i / 3});
        pages.push_back({{true, 1, 1}, 2, 1 + i % 2, 1 + i / 3});
        pages.push_back({{}, w.texture->layout().default_log2_width, i % 2, 1 + i / 3});
    }
    return pages;
}

// Texels of every texture of the pages that are resident, page by page.
std::map<std::string, std::vector<uint32_t>> texels_of(World& w, const std::vector<PageId>& pages) {
    std::map<std::string, std::vector<uint32_t>> out;
    const int side = w.texture->desc().pages_per_side;
    for (int which = 0; which < 3; ++which) {
        const std::vector<uint32_t> atlas = w.read_u32(w.texture->atlas(which));
        for (const PageId& page : pages) {
            const int place = w.texture->place_of(page);
            if (place < 0) continue;
            auto& texels = out[fmt::format("{} {} {} {}", page.image.live, page.depth, page.x, page.y)];
            for (int y = 0; y < kPageTexels; ++y) {
                const auto row = size_t((place / side * kPageTexels + y) * side * kPageTexels +
                                        place % side * kPageTexels);
                texels.insert(texels.end(), atlas.begin() + long(row),
                              atlas.begin() + long(row) + kPageTexels);
            }
        }
    }
    return out;
}

VirtualTextureDesc roomy_desc() {
    VirtualTextureDesc desc = small_desc(PageFormat::rgba8);
    desc.pages_per_side = 10;
    return desc;
}

TEST_F(LayerStreamTest, PagesAreThoseOfAllLayers) {
    for (const bool vista : {false, true}) {
        MapFixtureDesc map{.layers = kLayers};
        if (vista) map.ground = {.tile_hiding = true, .vista_scale = 6, .vista_distance_m = 5};
        map.transitions = {{.name = "mixed", .blend = LayerEntry::Blend{"layer 3", "layer 4", 0.5}}};
        World all(roomy_desc(), false, map, kAll), few(roomy_desc(), false, map, kFew);
        ASSERT_FALSE(all.layers->streams());
        ASSERT_TRUE(few.layers->streams());
        for (World* w : {&all, &few}) {
            paint_patches(*w);
            w->texture->request_pages(pages_to_want(*w));
            w->run_frames(80);
        }
        const auto stats = few.texture->statistics();
        EXPECT_EQ(stats.missing_pages + stats.dirty_pages + stats.low_res_pages, 0u);
        const auto whole = texels_of(all, pages_to_want(all)), streamed = texels_of(few, pages_to_want(few));
        EXPECT_GT(whole.size(), 12u);
        EXPECT_TRUE(streamed == whole);
        const LayerSet::Statistics layers = few.layers->statistics();
        EXPECT_EQ(layers.files, kLayers);
        EXPECT_LT(layers.slots, kLayers);
        // Coarse pages look at tails only; magnified lookups at finer levels, too.
        EXPECT_GT(layers.loads, vista ? uint64_t(layers.slots) : 0u);
        EXPECT_LT(few.layers->gpu_bytes(), all.layers->gpu_bytes());
        EXPECT_EQ(need(few.texture->count_stale_pages(*few.ring)), 0u);
    }
}

// What the others say is looked at: without waiting for whole layers pages are blurred.
TEST_F(LayerStreamTest, UntilTheyComePagesAreBlurredAndSaySo) {
    const MapFixtureDesc map{.layers = kLayers};
    World all(roomy_desc(), false, map, kAll), few(roomy_desc(), false, map, kFew);
    for (World* w : {&all, &few}) {
        paint_patches(*w);
        w->texture->request_pages(pages_to_want(*w));
    }
    all.run_frames(40);
    for (int i = 0; i < 40; ++i) {  // as World::record, but layers are never loaded
        gpu::Frame* frame = need(few.ring->begin());
        few.view.frame = ++few.frame_number;
        few.near = flat_sector_distances(few.document().bounds(), few.view.camera_m,
                                         few.texture->live_radius_m(few.view.pixels_per_radian, 0));
        few.view.near = few.near;
        few.texture->request_inputs(few.view);
        need(few.index->update(*few.ring, frame->commands, few.frame_number, 8));
        need(few.texture->update(*few.ring, frame->commands, few.view));
        need(few.ring->end(*frame));
    }
    EXPECT_EQ(few.texture->statistics().missing_pages, 0u) << "there is something to see at once";
    EXPECT_GT(few.texture->statistics().low_res_pages, 0u);
    EXPECT_FALSE(few.texture->settled());
    EXPECT_FALSE(texels_of(few, pages_to_want(few)) == texels_of(all, pages_to_want(all)));
    few.run_frames(80);
    EXPECT_EQ(few.texture->statistics().low_res_pages, 0u);
    EXPECT_TRUE(texels_of(few, pages_to_want(few)) == texels_of(all, pages_to_want(all)));
}

// It stays with tails, and an edit of a part of it does not make that part another.
TEST_F(LayerStreamTest, PageOfMoreLayersThanSlots) {
    MapFixtureDesc map{.layers = kLayers};
    map.ground = {.vista_scale = 16, .vista_distance_m = 1};
    World all(roomy_desc(), false, map, kAll);
    World w(roomy_desc(), false, map, {.texels = 256, .budget_bytes = 1});
    ASSERT_EQ(w.layers->statistics().slots, 8);
    for (World* world : {&all, &w}) {
        paint_patches(*world);
        world->texture->request_pages(pages_to_want(*world));
        world->run_frames(80);
    }
    for (int i = 0; i < 2; ++i) {
        const auto stats = w.texture->statistics();
        EXPECT_EQ(stats.missing_pages + stats.dirty_pages + stats.low_res_pages, 0u);
        EXPECT_FALSE(texels_of(w, pages_to_want(w)) == texels_of(all, pages_to_want(all)));
        EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
        w.on_dirt(need(w.document().apply(
            {.body = PaintCommand{.dabs = {{88, 96}}, .radius_m = 2, .layer = "layer 9"}})));
        w.run_frames(40);
    }
}

TEST_F(LayerStreamTest, LostFileIsShownFromItsTail) {
    World w(roomy_desc(), false, {.layers = kLayers}, kFew);
    paint_patches(w, false);
    for (int i = 3; i < kLayers; i += 2)
        std::filesystem::remove(w.document().folder() / ("layers/layer " + std::to_string(i) + ".layer"));
    w.texture->request_pages(pages_to_want(w));
    w.run_frames(80);
    const auto stats = w.texture->statistics();
    EXPECT_EQ(stats.missing_pages + stats.dirty_pages + stats.low_res_pages, 0u)
        << "it does not wait for ever";
    EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
}

}  // namespace
}  // namespace loam::test
