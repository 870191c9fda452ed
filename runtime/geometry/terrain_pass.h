// Draws the patches of a PatchSet: the prepass (depth, stencil 1, G-buffer, ambient occlusion) and shadow
// maps.
//
//     LOAM_TRY(terrain.upload(ring, commands, patches));                     // once a frame, outside of
//     rendering commands.begin_rendering(extent, {gbuffer, occlusion}, depth); commands.set_viewport(…);
//     terrain.cmd_draw_prepass(commands, patches, heights, clip_from_rel, patches.camera_m);
//     commands.end_rendering();
//
// HeightMap::update leaves the height arrays readable in vertex and fragment shaders: no barrier is needed
// between. A PatchSet is good for the frame in which it was selected (and two more: ejected slots rest).
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "runtime/geometry/patch_tree.h"
#include "runtime/gpu/commands.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/pipeline.h"

namespace loam {

// Of vkCmdSetDepthBias; reversed Z, so that negative values move a surface away from the light.
struct DepthBias {
    float constant = 0, slope = 0;
};

class TerrainPass {
  public:
    // Colour formats: G-buffer (RGBA16F) and ambient occlusion (R8). The prepass needs a stencil in
    // `depth_stencil`.
    static Result<TerrainPass> create(gpu::Device& device, const std::vector<VkFormat>& color_formats,
                                      VkFormat depth_stencil, VkFormat shadow_depth = VK_FORMAT_D32_SFLOAT);

    // This frame's instances; the first time that patches have holes, the pipelines for those.
    Status upload(gpu::FrameRing& ring, gpu::Commands& commands, const PatchSet& patches);
    // Inside begun rendering: the visible patches; depth GREATER, stencil replaced by 1. `camera_m` must be
    // that of the set.
    void cmd_draw_prepass(gpu::Commands& commands, const PatchSet& patches, const HeightMap& heights,
                          const glm::mat4& clip_from_rel, const glm::dvec3& camera_m);
    // Debug view: inside begun rendering of one colour target of `format`, over the depth of a prepass of the
    // same set: the level of the height page under each pixel. Its pipeline is made when first used.
    Status cmd_draw_levels(gpu::Commands& commands, const PatchSet& patches, const HeightMap& heights,
                           const glm::mat4& clip_from_rel, VkFormat format);
    // Inside begun rendering without colour: the patches of the set that `seen_from_rel` sees, by the first
    // matrix; depth GREATER.
    void cmd_draw_shadow(gpu::Commands& commands, const PatchSet& patches, const HeightMap& heights,
                         const glm::dmat4& clip_from_rel, const glm::dmat4& seen_from_rel,
                         const glm::dvec3& camera_m, const DepthBias& bias = {});

  private:
    Status create_cut_pipelines();
    void bind(gpu::Commands& commands, const gpu::Pipeline& pipeline, const PatchSet& patches,
              const HeightMap& heights, const glm::mat4& clip_from_rel);

    gpu::Device* device_ = nullptr;
    std::vector<VkFormat> color_formats_;
    VkFormat depth_stencil_ = VK_FORMAT_UNDEFINED, shadow_depth_ = VK_FORMAT_UNDEFINED;
    gpu::Pipeline prepass_, shadow_, levels_;
    gpu::Pipeline prepass_cut_, shadow_cut_;  // of patches with holes
    gpu::Sampler nearest_, linear_;
    gpu::Buffer indices_;
    gpu::UploadSlice instances_;
};

}  // namespace loam
