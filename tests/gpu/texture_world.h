// A small map with three layers and a virtual texture over it.
#pragma once

#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/check.h"
#include "runtime/maps/index_map.h"
#include "runtime/store/layer_file.h"
#include "runtime/texture/virtual_texture.h"
#include "tests/gpu/test_device.h"
#include "tests/unit/map_fixture.h"

namespace loam::test {

template <typename T>
T need(Result<T> result) {
    LOAM_CHECK(result.ok(), result.ok() ? "" : result.message());
    return std::move(result.value());
}
inline void need(const Status& status) {
    LOAM_CHECK(status.ok(), status.ok() ? "" : status.message());
}

// Rough: noise of the texel; flat: one colour. Of four layers one has a reveal of 0 and one of 1 everywhere.
inline LayerTextures make_layer(int seed, bool flat, int size_texels = 64) {
    LayerTextures t;
    t.size_texels = size_texels;
    t.albedo_reveal.resize(1);
    t.normal_gloss_occlusion.resize(1);
    t.metalness.resize(1);
    for (int i = 0; i < size_texels * size_texels; ++i) {
        const uint32_t h =
            flat ? uint32_t(seed) * 2654435761u : (uint32_t(i) + uint32_t(seed) * 7919u) * 2654435761u;
        const uint8_t reveal = seed % 4 == 3 ? 255 : seed % 4 == 0 ? 0 : uint8_t((h >> 20) % 255);
        const auto byte = [&](int shift, int low, int high) {
            return uint8_t(low + int((h >> shift) % uint32_t(high - low)));
        };
        t.albedo_reveal[0].insert(t.albedo_reveal[0].end(),
                                  {byte(3, 60, 160), byte(9, 60, 140), byte(14, 40, 120), reveal});
        const uint8_t nx = flat ? 128 : byte(7, 100, 156), ny = flat ? 128 : byte(13, 100, 156);
        t.normal_gloss_occlusion[0].insert(t.normal_gloss_occlusion[0].end(),
                                           {nx, ny, byte(17, 40, 120), byte(5, 180, 255)});
        t.metalness[0].push_back(0);
    }
    build_layer_mips(t);
    return t;
}

struct WorldLayers {
    int texels = 64;
    uint64_t budget_bytes = LayerSet::kBudgetBytes;
    bool compressed_tints = true;
};

struct World {
    explicit World(const VirtualTextureDesc& desc, bool flat_layers = false, const MapFixtureDesc& map = {},
                   const WorldLayers& set = {})
        : fixture(map) {
        const auto layers_folder = document().folder() / "layers";
        std::filesystem::create_directories(layers_folder);
        int seed = 1;
        for (const LayerEntry& entry : document().settings().layers)
            if (!entry.blend)
                need(save_layer(document().folder() / entry.file,
                                make_layer(seed++, flat_layers, set.texels)));
        ring = need(gpu::FrameRing::create(gpu::test_device(), 2));
        layers = need(LayerSet::create(*ring, document(), set.budget_bytes));
        index = need(IndexMap::create(&gpu::test_device(), document(),
                                      {.slot_count = 40, .compressed_tints = set.compressed_tints}));
        texture = need(VirtualTexture::create(gpu::test_device(), document(), *index, *layers, desc));
    }
    Document& document() { return fixture.document(); }
    void on_dirt(const Dirt& dirt, bool tell_texture = true) {
        index->on_dirt(dirt.index);
        if (!tell_texture) return;
        texture->on_index_dirt(dirt.index);
        texture->on_height_dirt(dirt.height);  // volumes lie on the ground
        texture->on_dirt(dirt.texture, dirt.texture_size_m);
    }
    void run_frames(int count) {
        for (int i = 0; i < count; ++i) {
            gpu::Frame* frame = need(ring->begin());
            record(frame->commands);
            need(ring->end(*frame));
        }
    }
    void record(gpu::Commands& commands) {
        view.frame = ++frame_number;
        near = flat_sector_distances(document().bounds(), view.camera_m,
                                     texture->live_radius_m(view.pixels_per_radian, view.mip_bias));
        view.near = near;
        texture->request_inputs(view);
        need(index->update(*ring, commands, frame_number, 8));
        need(layers->update(*ring, commands, true));
        need(texture->update(*ring, commands, view));
    }
    // Pages around the camera: the finest of its sector, of the default image, and all above them.
    void want_some_pages() {
        std::vector<PageId> pages;
        for (int i = 0; i < 4; ++i) {
            pages.push_back({{true, 1, 1}, 6, 20 + i % 2, 31 + i / 2});
            pages.push_back({{}, texture->layout().default_log2_width, i % 2, 1 + i / 2});
        }
        texture->request_pages(pages);
    }
    template <typename Image>
    std::vector<uint32_t> read_u32(Image& image, uint32_t mip = 0) {
        std::vector<uint32_t> got;
        gpu::Frame* frame = need(ring->begin());
        const auto take = [&](std::span<const std::byte> bytes) {
            got.resize(bytes.size() / 4);
            std::memcpy(got.data(), bytes.data(), bytes.size());
        };
        ring->read_back(frame->commands, image, take, mip);
        need(ring->finish(*frame));
        return got;
    }

    MapFixture fixture;
    std::unique_ptr<gpu::FrameRing> ring;
    std::unique_ptr<LayerSet> layers;
    std::unique_ptr<IndexMap> index;
    std::unique_ptr<VirtualTexture> texture;
    // Near enough that its sector's image is 64 x 64 pages.
    TextureView view{.camera_m = {64 + 21.5, 64 + 32.5, 5}, .pixels_per_radian = 800};
    std::vector<SectorDistance> near;
    uint64_t frame_number = 0;
};

inline VirtualTextureDesc small_desc(PageFormat format) {
    return {.pages_per_side = 6,
            .indirection_size = 256,
            .format = format,
            .max_live_sectors = 1,
            .budget_pages = 8};
}

}  // namespace loam::test
