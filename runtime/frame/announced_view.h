// The place that the camera will jump to, looked at before it does: its cut of the ground and a small
// prepass, whose feedback asks for the pages that its first picture will want. Source: Call of Duty talk,
// "Battle Against Low-Rez VT": the game is told of teleports and pages are made where the camera will be.
// Differs: the very pages, by their own feedback, not medium ones.
#pragma once

#include <optional>

#include "runtime/frame/camera.h"
#include "runtime/frame/targets.h"
#include "runtime/geometry/patch_tree.h"
#include "runtime/geometry/terrain_pass.h"
#include "runtime/gpu/frame_ring.h"

namespace loam {

struct AnnouncedView {
    Camera camera;
    FrameTargets targets;
    PatchSet patches;
    glm::uvec2 size{0};  // of the small picture
    float footprint_log2 = 0;

    // Selects the ground and requests its height pages; before HeightMap::update. picture_px: of the picture
    // that is rendered now, as the first at the new place will be: one of another size has other sectors
    // live, and wants other pages.
    void prepare(HeightMap& heights, const CutoutMap& cutouts, glm::uvec2 picture_px, double split_distance);
};

// Depth, stencil, geometric normal and footprint of a set of patches, into the targets.
void cmd_prepass(gpu::Commands& commands, TerrainPass& terrain, FrameTargets& targets, HeightMap& heights,
                 const PatchSet& patches, glm::uvec2 size, const glm::mat4& clip_from_rel);

}  // namespace loam
