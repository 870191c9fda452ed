// Composes rectangles of pages on the GPU: materials (compute), decals (graphics), compression (compute),
// copy into the physical textures. Many rectangles share the scratch images: they are packed on shelves, and
// a full scratch is flushed. A batch is a fixed number of dispatches and copies, whatever the number of its
// rectangles: shaders find theirs in lists of tiles of 8x8 texels, a list for each kind of ground.
//
// A rectangle is aligned to 8 texels, so that it holds whole blocks of both mips. The second mip is the mean
// of the first; where vista UVs or imagery weigh otherwise in the next coarser page, it is composed as that
// page's texels are, so that going from page to page shows no step. Each texel is a function of its place in
// the page and of the inputs only: a rectangle composed alone has the bytes that it has as part of the whole
// page. Source: Call of Duty talk, "Composition", "Compression", "Physical Textures".
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/maps/index_map.h"
#include "runtime/texture/decal_passes.h"
#include "runtime/texture/layer_set.h"
#include "runtime/texture/virtual_texture.h"
#include "shaders/texture/compose_io.h"

namespace loam {

// Of vista_weight (shaders/texture/vista.h), for what begins at a distance.
[[nodiscard]] double far_log2_begin(double distance_m);

// Layers by an alpha mask each instead of the index map: the baseline, for one index page.
// Source: Call of Duty talk, "Layer Masks".
struct LayerMasks {
    gpu::Image pages;  // R8_UNORM 136 x 136, one a layer
    MapPage index_page;
};
inline constexpr int kMostMasks = 32;

struct ComposeJob {
    PageId page;
    TexelRect rect;        // aligned to LayerSet::rect_texels
    glm::ivec2 target{0};  // physical page
    MapPage index_page;    // resident and clean
    int index_slot = 0;
    LayerTier tier = LayerTier::whole;  // of all of the page, whatever part of it this is
};

class Composer {
  public:
    static Result<std::unique_ptr<Composer>> create(gpu::Device& device, const Document& document,
                                                    IndexMap& index, LayerSet& layers,
                                                    const TextureLayout& layout, const PageTextures& textures,
                                                    bool decals);
    // After LayerSet::take_settings: the pipelines for what is on now.
    Status take_settings();
    // What cmd_compose composes of from now on, in pages within masks.index_page; null: the index map.
    Status use_masks(LayerMasks* masks);
    // What a job reads of the layers, its second mip and its decals with it. Takes the document's ReadLock.
    [[nodiscard]] LayerNeeds needs_of(const ComposeJob& job) const;
    Status cmd_compose(gpu::FrameRing& ring, gpu::Commands& commands, std::span<const ComposeJob> jobs,
                       PageAtlas& atlas);

    // Of the colour channels of a layout's textures in the block compressor. Normals and gloss carry the
    // picture; occlusion, metalness and optional channels bear more error. By eye on rock and grass.
    static constexpr glm::vec4 kRowWeights[kMaxPageTextures] = {
        {1, 1, 1, 0}, {0.7f, 1, 0.4f, 0}, {0.5f, 1, 0.3f, 0}, {1, 1, 1, 0}};
    static constexpr glm::vec4 kPairWeights[kMaxPageTextures] = {
        {1, 1, 1, 0}, {0.4f, 1, 0.7f, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
    [[nodiscard]] uint64_t gpu_bytes() const;
    // How a layer lies in a page; also of use to tests.
    static shared::LayerPlace layer_place(double origin_x_m, double origin_y_m, double side_m, double texel_m,
                                          double tile_m, int layer_texels, double vista_scale);

  private:
    struct Placed;  // a job with its place in scratch and in the buffers
    struct Work;
    Composer(gpu::Device& device, const Document& document, IndexMap& index, LayerSet& layers,
             const TextureLayout& layout, const PageTextures& textures);
    [[nodiscard]] Result<gpu::Pipeline> material_pipeline(int kind, bool masks) const;
    struct IndexWindow;
    [[nodiscard]] IndexWindow index_window(const ComposeJob& job) const;
    void add_needs(const ComposeJob& job, LayerNeeds& needs) const;
    [[nodiscard]] Placed prepare(const ComposeJob& job, glm::ivec2 scratch_min);
    // What weighs by the distance that a page's texels are meant for.
    struct FarWeights {
        float vista = 0, imagery = 0;
        bool operator==(const FarWeights&) const = default;
    };
    [[nodiscard]] FarWeights far_of(const PageId& page) const;
    [[nodiscard]] std::optional<ComposeJob> second_mip(const ComposeJob& job) const;
    Status cmd_batch(gpu::FrameRing& ring, gpu::Commands& commands, std::vector<Placed>& batch,
                     PageAtlas& atlas);
    [[nodiscard]] Work upload(gpu::FrameRing& ring, std::span<Placed> batch);
    void cmd_materials(gpu::FrameRing& ring, gpu::Commands& commands, std::span<const Placed> batch,
                       const Work& work);
    Status cmd_decals(gpu::FrameRing& ring, gpu::Commands& commands, std::span<const Placed> batch);
    // Of compressed formats.
    void cmd_encode_blocks(gpu::Commands& commands, const Work& work);
    void cmd_copy_blocks(gpu::Commands& commands, std::span<const Placed> batch, PageAtlas& atlas);
    // Of the others.
    void cmd_copy_texels(gpu::Commands& commands, std::span<const Placed> batch, PageAtlas& atlas);
    void cmd_write_mips(gpu::Commands& commands, const Work& work, PageAtlas& atlas);

    gpu::Device& device_;
    const Document& document_;
    IndexMap& index_;
    LayerSet& layers_;
    TextureLayout layout_;
    PageTextures textures_;
    gpu::Image scratch_;  // see shaders/texture/page_format.h
    gpu::Buffer blocks_;  // of compressed formats
    gpu::Sampler nearest_;
    // By one layer only (1), transitions (2) and what weighs by distance, vista UVs and imagery (4): a square
    // of 8 texels runs the one for what is in it.
    static constexpr size_t kKinds = 8;
    std::array<gpu::Pipeline, kKinds> materials_;
    LayerMasks* masks_ = nullptr;
    gpu::Pipeline mask_material_;
    gpu::Pipeline encode_[2];  // by mip; mip 0 of uncompressed pages is a copy
    std::optional<DecalPasses> decals_;
    std::array<bool, 5>
        features_{};  // tile hiding, distortion, transitions, vista, imagery: of the pipelines
};

}  // namespace loam
