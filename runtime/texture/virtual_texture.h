// The adaptive virtual texture: sectors, virtual images with their page quad trees, the indirection texture,
// feedback, composition and compression. Pages are usable the frame after they were composed and rest three frames
// before their place is used again.
// Source: Call of Duty talk, from "Virtual Texture" to "Scalability".
#pragma once

#include <functional>
#include <memory>
#include <span>

#include <glm/vec3.hpp>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/maps/index_map.h"
#include "runtime/texture/layer_set.h"

namespace loam {

enum class PageFormat { bc1x3, rgba8 }; // three BC1 textures, or three RGBA8 (the uncompressed comparison, fast on software devices)

struct VirtualTextureDesc {
    int pages_per_side = 22;      // physical texture: very low 13, low 16, mid 22, high 30, ultra 42
    int indirection_size = 1024;  // texels a side
    PageFormat format = PageFormat::bc1x3;
    int sector_log2_width = 6;    // live sectors' images are 64x64 pages
    int max_live_sectors = 64;
    int budget_pages = 2;         // whole pages composed a frame
    bool decals = true;
};

struct TextureView {
    glm::dvec3 camera_m{0};
    double pixels_per_radian = 500; // picture height / (2 tan(fov_y / 2)): sizes the live radius
    uint64_t frame = 0;
    float mip_bias = 0;
};

class VirtualTexture {
  public:
    static Result<std::unique_ptr<VirtualTexture>> create(gpu::Device& device, const Document& document, IndexMap& index,
                                                          LayerSet& layers, const VirtualTextureDesc& desc);
    ~VirtualTexture();

    // World rectangles whose texels change (index dirt grown by its filter, and decals).
    void on_dirt(std::span<const WorldRect> rects);

    // Requests index pages for what will be composed; call before IndexMap::update.
    void request_inputs(const TextureView& view);
    // Makes last frame's pages usable, applies feedback, composes dirty rectangles first, then missing pages within the
    // budget, and updates indirection and sector table.
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, const TextureView& view);
    // After the prepass: 240x136 wanted pages, read back when the GPU has passed this frame.
    // depth: the prepass' depth (Access::depth_sampled), gbuffer: normal.xy, log2 footprints (see frame_io.h).
    Status record_feedback(gpu::FrameRing& ring, gpu::Commands& commands, gpu::Image& depth, gpu::Image& gbuffer,
                           const gpu::Buffer& frame_uniforms, uint64_t uniforms_offset);

    // --- for shaders that include shaders/texture/vt_sample.glsl (its head says which slots) ---
    [[nodiscard]] gpu::Image& atlas(int which); // 0 albedo, 1 gloss+normal x+occlusion, 2 metalness+normal y+feature
    [[nodiscard]] gpu::Image& indirection();    // R32_UINT
    [[nodiscard]] gpu::Buffer& sector_table();
    [[nodiscard]] gpu::Buffer& params();        // VtParams of this frame
    [[nodiscard]] const gpu::Sampler& sampler() const;

    [[nodiscard]] bool settled() const; // nothing dirty, nothing missing, last feedback all satisfied
    struct Statistics {
        uint32_t resident_pages = 0, capacity_pages = 0, live_sectors = 0, requested_pages = 0, missing_pages = 0;
        uint32_t dirty_pages = 0;
        uint64_t pages_dirtied = 0, pages_composed = 0, rects_composed = 0, texels_composed = 0; // since start
        uint64_t gpu_bytes = 0;
    };
    [[nodiscard]] Statistics statistics() const;

    // Tests: every resident page composed again from nothing into scratch and compared with what is in the atlas.
    // Returns the number of pages that differ in any byte (all mips, all three textures).
    Result<uint32_t> count_stale_pages(gpu::FrameRing& ring);

  private:
    VirtualTexture();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace loam
