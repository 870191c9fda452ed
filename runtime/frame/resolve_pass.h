// The resolve: sky, then every pixel with the terrain's stencil shaded from the virtual texture or, for the
// reference, directly. It exists as pipelines, not branches, made when first used. Source: Call of Duty talk,
// "Terrain Rendering".
#pragma once

#include <array>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/frame/frame_settings.h"
#include "runtime/frame/targets.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/maps/index_map.h"
#include "runtime/scene/shadow_cascades.h"
#include "runtime/texture/virtual_texture.h"

namespace loam {

// What a resolve reads; all of this frame.
struct ResolveInputs {
    FrameTargets& targets;
    ShadowCascades& shadows;
    VirtualTexture& texture;
    IndexMap& indices;
    LayerSet& layers;
    glm::uvec2 size;            // pixels of the targets that the frame fills
    gpu::UploadSlice uniforms;  // FrameUniforms
    gpu::UploadSlice decals;    // DirectDecal, for direct shading
    bool has_decals = false;
};

// The frame draws sky and ground; benches draw the ground alone, or its floor (resolve_floor.frag).
enum class ResolvePart { all, ground, floor };

class ResolvePass {
  public:
    // The sky's pipeline and those that a window needs at once.
    static Result<ResolvePass> create(gpu::Device& device, const LayerSet& layers,
                                      const PageTextures& textures);

    // After LayerSet::take_settings: direct shading is another pipeline then.
    void take_settings();
    // Reads the prepass' targets, writes the picture (left in Access::color_target).
    Status cmd_record(gpu::Commands& commands, const ResolveInputs& inputs, const FrameSettings& settings,
                      ResolvePart part);

  private:
    enum class Kind {
        fast,
        fine,
        debug,
        direct,
        direct_decals,
        texels,
        texels_decals,
        floor,
        floor_fine,
        count
    };

    explicit ResolvePass(gpu::Device& device) : device_(&device) {}
    Status make_fixed();
    // Those made for pages of another layout are dropped.
    Result<gpu::Pipeline*> pipeline(Kind kind, const LayerSet& layers, const PageTextures& textures);

    gpu::Device* device_;
    gpu::Sampler point_;
    gpu::Pipeline sky_;
    std::array<gpu::Pipeline, size_t(Kind::count)> pipelines_;
    uint32_t layout_ = 0, placement_ = 0;  // PageTextures' that the pipelines are made for
};

}  // namespace loam
