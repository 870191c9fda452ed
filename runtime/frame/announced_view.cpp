#include "runtime/frame/announced_view.h"

#include <algorithm>
#include <cmath>

#include "shaders/geometry/pixel_ellipse_math.h"

namespace loam {

namespace {
constexpr uint32_t kReduction = 4;   // of the picture's width and height
constexpr double kSplitShare = 0.5;  // a coarser cut, so that the picture's own ground stays resident
}  // namespace

void AnnouncedView::prepare(HeightMap& heights, const CutoutMap& cutouts, glm::uvec2 picture_px,
                            double split_distance) {
    size = glm::max(picture_px / kReduction, glm::uvec2(8));
    footprint_log2 = float(std::log2(double(size.y) / picture_px.y));
    patches = select_patches(heights, {.camera_m = camera.position_m,
                                       .clip_from_rel = camera.clip_from_rel(size.x, size.y, {0, 0}),
                                       .split_distance = split_distance * kSplitShare,
                                       .hidden_share = 0.0,
                                       .cutouts = &cutouts});
}

void cmd_prepass(gpu::Commands& commands, TerrainPass& terrain, FrameTargets& targets, HeightMap& heights,
                 const PatchSet& patches, glm::uvec2 size, const glm::mat4& clip_from_rel) {
    using gpu::Access;
    const auto pass = commands.pass("prepass", {{targets.depth, Access::depth_target},
                                                {targets.gbuffer, Access::color_target},
                                                {targets.occlusion, Access::color_target},
                                                {heights.heights(), Access::vertex_read},
                                                {heights.normals(), Access::fragment_sampled}});
    constexpr VkClearColorValue no_ground{{0, 0, kNoGroundLog2, kNoGroundLog2}};
    const gpu::ColorTarget colors[] = {{targets.gbuffer.view(), VK_ATTACHMENT_LOAD_OP_CLEAR, no_ground},
                                       {targets.occlusion.view(), VK_ATTACHMENT_LOAD_OP_CLEAR, {}}};
    commands.begin_rendering(
        {size.x, size.y}, colors,
        {.view = targets.depth.view(), .load = VK_ATTACHMENT_LOAD_OP_CLEAR, .has_stencil = true});
    commands.set_viewport(0, 0, float(size.x), float(size.y));
    terrain.cmd_draw_prepass(commands, patches, heights, clip_from_rel, patches.camera_m);
    commands.end_rendering();
}

}  // namespace loam
