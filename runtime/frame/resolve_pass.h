// The resolve: sky, then every pixel with the terrain's stencil shaded from the virtual texture or, for the
// reference, directly. It exists as pipelines, not branches, made when first used. Source: Call of Duty talk,
// "Terrain Rendering".
#pragma once

#include <compare>
#include <map>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/frame/filter_tiles.h"
#include "runtime/frame/frame_settings.h"
#include "runtime/frame/targets.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/maps/index_map.h"
#include "runtime/scene/shadow_cascades.h"
#include "runtime/texture/paint_decals.h"
#include "runtime/texture/virtual_texture.h"
#include "shaders/frame/resolve_io.h"

namespace loam {

// What a resolve reads; all of this frame.
struct ResolveInputs {
    FrameTargets& targets;
    ShadowCascades& shadows;
    VirtualTexture& texture;
    IndexMap& indices;
    LayerSet& layers;
    glm::uvec2 size;                            // pixels of the targets that the frame fills
    gpu::UploadSlice uniforms;                  // FrameUniforms
    gpu::UploadSlice decals, paints, segments;  // DirectDecal, PaintDecal, PaintSegment, for direct shading
    bool has_decals = false, has_paints = false;
    const FunctionList* functions = nullptr;    // that the paints show, for direct shading
    gpu::UploadSlice facts, squares;            // VtPlaceFacts and VtImageSquare, for debug views
};

// The frame draws sky and ground (or the sky alone, where a debug view draws the ground); benches draw the
// ground alone, or its floor (resolve_floor.frag).
enum class ResolvePart { all, sky, ground, floor };

class ResolvePass {
  public:
    // The sky's pipeline and those that a window needs at once, with the filters it moves and rests with.
    static Result<ResolvePass> create(gpu::Device& device, const LayerSet& layers,
                                      const PageTextures& textures, Filter moving, Filter resting);

    // After LayerSet::take_settings: direct shading is another pipeline then.
    void take_settings();
    // Reads the prepass' targets, writes the picture (left in Access::color_target).
    // `settings` names its filter.
    Status cmd_record(gpu::Commands& commands, const ResolveInputs& inputs, const FrameSettings& settings,
                      ResolvePart part);
    // The lists of the newest resolve that was drawn by tiles.
    [[nodiscard]] FilterTiles& tiles() { return tiles_; }

  private:
    // Everything that makes it another pipeline.
    struct Variant {
        enum class Ground { cached, direct, direct_texels, floor } ground = Ground::cached;
        bool fine_shadows = false, decals = false, paints = false, functions = false, tiles = false;
        bool debug = false, map = false;  // map: a debug view of the textures themselves, over the whole picture
        bool two_mips = false, hardware = false;
        int parallax_steps = 0;
        int taps = 1, probes = 1;  // of the virtual texture, shaders/texture/vt_sample.glsl
        // Pages are made of whole mips of the layers; a pixel at rest is not.
        [[nodiscard]] bool smooth_layers() const { return ground == Ground::direct && fine_shadows; }
        auto operator<=>(const Variant&) const = default;
    };

    explicit ResolvePass(gpu::Device& device) : device_(&device) {}
    Status make_fixed();
    // The shader of direct shading with these functions; pipelines with others are dropped.
    Status take_functions(const FunctionList& functions);
    [[nodiscard]] Variant variant(const FrameSettings& settings, ResolvePart part, bool has_decals,
                                  bool has_paints) const;
    // Those made for pages of another layout are dropped.
    Result<gpu::Pipeline*> pipeline(const Variant& variant, const LayerSet& layers,
                                    const PageTextures& textures);
    Status cmd_tiles(gpu::Commands& commands, const ResolveInputs& inputs, Variant variant, int most_taps,
                     std::vector<gpu::Bound> bound, shared::ResolvePush push);

    gpu::Device* device_;
    gpu::Sampler point_;
    gpu::Sampler anisotropic_;  // of the pages; made when first used
    gpu::Pipeline sky_;
    std::map<Variant, gpu::Pipeline> pipelines_;
    FunctionList functions_;               // of direct shading's pipelines
    uint32_t layout_ = 0, placement_ = 0;  // PageTextures' that the pipelines are made for
    FilterTiles tiles_;
};

}  // namespace loam
