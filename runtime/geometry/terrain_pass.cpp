#include "runtime/geometry/terrain_pass.h"

#include "runtime/base/check.h"

#include <cstring>

namespace loam {

namespace {

constexpr uint32_t kIndexCount = kPatchQuads * kPatchQuads * 6;

// Two triangles a quad, counter-clockwise seen from above; diagonals alternate, so that ridges in neither
// direction are favoured.
std::vector<uint16_t> grid_indices() {
    std::vector<uint16_t> indices;
    for (int y = 0; y < kPatchQuads; ++y)
        for (int x = 0; x < kPatchQuads; ++x) {
            const int a = y * (kPatchQuads + 1) + x, b = a + 1, c = a + kPatchQuads + 1, d = c + 1;
            const int even[] = {a, b, d, a, d, c}, odd[] = {a, b, c, b, d, c};
            for (const int i : (x + y) % 2 == 0 ? even : odd) indices.push_back(static_cast<uint16_t>(i));
        }
    return indices;
}

gpu::GraphicsDesc patch_pipeline(const char* name, VkFormat depth_format) {
    gpu::GraphicsDesc desc;
    desc.name = name;
    desc.vertex_shader = "geometry/terrain.vert";
    desc.bindings = {gpu::storage_buffer(0), gpu::sampled_image(1)};
    desc.push_bytes = sizeof(shared::GeometryPush);
    desc.depth_format = depth_format;
    desc.depth_test = desc.depth_write = true;
    return desc;
}

}  // namespace

Result<TerrainPass> TerrainPass::create(gpu::Device& device, const std::vector<VkFormat>& color_formats,
                                        VkFormat depth_stencil, VkFormat shadow_depth) {
    static_assert(sizeof(shared::GeometryPush) <= 128);
    TerrainPass pass;
    pass.device_ = &device;
    pass.depth_stencil_ = depth_stencil;
    gpu::GraphicsDesc desc = patch_pipeline("terrain prepass", depth_stencil);
    desc.fragment_shader = "geometry/terrain_prepass.frag";
    desc.bindings.push_back(gpu::sampled_image(2));
    desc.color_formats = color_formats;
    desc.stencil.enable = true;
    desc.stencil.pass = VK_STENCIL_OP_REPLACE;
    desc.stencil.reference = 1;
    auto prepass = gpu::Pipeline::create(device, desc);
    if (!prepass) return prepass.error();
    pass.prepass_ = std::move(*prepass);

    desc = patch_pipeline("terrain shadow", shadow_depth);
    desc.depth_bias = true;
    auto shadow = gpu::Pipeline::create(device, desc);
    if (!shadow) return shadow.error();
    pass.shadow_ = std::move(*shadow);

    gpu::SamplerDesc sampler;
    auto linear = gpu::Sampler::create(device, sampler);
    if (!linear) return linear.error();
    pass.linear_ = std::move(*linear);
    sampler.filter = VK_FILTER_NEAREST;
    auto nearest = gpu::Sampler::create(device, sampler);
    if (!nearest) return nearest.error();
    pass.nearest_ = std::move(*nearest);

    const std::vector<uint16_t> indices = grid_indices();
    gpu::BufferDesc buffer;
    buffer.name = "patch grid";
    buffer.size_bytes = indices.size() * sizeof(uint16_t);
    buffer.usage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    buffer.memory = gpu::MemoryUse::upload;
    auto created = gpu::Buffer::create(device, buffer);
    if (!created) return created.error();
    pass.indices_ = std::move(*created);
    std::memcpy(pass.indices_.mapped(), indices.data(), buffer.size_bytes);
    return pass;
}

Status TerrainPass::upload(gpu::FrameRing& ring, gpu::Commands&, const PatchSet& patches) {
    instances_ = {};
    if (patches.patches.empty()) return {};
    const uint64_t bytes = patches.patches.size() * sizeof(shared::PatchInstance);
    instances_ = ring.upload(bytes);
    if (!instances_.data) return error("no memory for {} terrain patches", patches.patches.size());
    std::memcpy(instances_.data, patches.patches.data(), bytes);
    return {};
}

void TerrainPass::bind(gpu::Commands& commands, const gpu::Pipeline& pipeline, const PatchSet& patches,
                       const HeightMap& heights, const glm::mat4& clip_from_rel, bool with_normals) {
    const gpu::Bound instances(0, *instances_.buffer, instances_.offset,
                               patches.patches.size() * sizeof(shared::PatchInstance));
    const gpu::Bound height_array(1, heights.heights().view(), nearest_);
    if (with_normals)
        commands.bind(pipeline, {instances, height_array, {2, heights.normals().view(), linear_}});
    else
        commands.bind(pipeline, {instances, height_array});

    shared::GeometryPush push{};
    push.clip_from_rel = clip_from_rel;
    push.origin_rel_m = glm::vec2(patches.origin_rel_m);
    push.step_m = static_cast<float>(patches.step_m);
    push.camera_z_m = static_cast<float>(patches.camera_m.z);
    push.map_edge_rel_m = glm::vec2(patches.map_edge_rel_m);
    commands.push(pipeline, push);
    vkCmdBindIndexBuffer(commands.handle(), indices_.handle(), 0, VK_INDEX_TYPE_UINT16);
}

void TerrainPass::cmd_draw_prepass(gpu::Commands& commands, const PatchSet& patches, const HeightMap& heights,
                                   const glm::mat4& clip_from_rel, const glm::dvec3& camera_m) {
    LOAM_CHECK(camera_m == patches.camera_m, "patches were selected for another camera");
    if (!instances_.data || patches.visible_count == 0) return;
    bind(commands, prepass_, patches, heights, clip_from_rel, true);
    vkCmdDrawIndexed(commands.handle(), kIndexCount, uint32_t(patches.visible_count), 0, 0, 0);
}

Status TerrainPass::cmd_draw_levels(gpu::Commands& commands, const PatchSet& patches,
                                    const HeightMap& heights, const glm::mat4& clip_from_rel,
                                    VkFormat format) {
    if (!levels_) {
        gpu::GraphicsDesc desc = patch_pipeline("terrain levels", depth_stencil_);
        desc.fragment_shader = "geometry/terrain_level.frag";
        desc.bindings.push_back(gpu::sampled_image(2));
        desc.color_formats = {format};
        desc.depth_write = false;
        desc.depth_compare = VK_COMPARE_OP_EQUAL;  // gl_Position is invariant
        auto made = gpu::Pipeline::create(*device_, desc);
        if (!made) return made.error();
        levels_ = std::move(*made);
    }
    if (!instances_.data || patches.visible_count == 0) return {};
    bind(commands, levels_, patches, heights, clip_from_rel, true);
    vkCmdDrawIndexed(commands.handle(), kIndexCount, uint32_t(patches.visible_count), 0, 0, 0);
    return {};
}

void TerrainPass::cmd_draw_shadow(gpu::Commands& commands, const PatchSet& patches, const HeightMap& heights,
                                  const glm::dmat4& clip_from_rel, const glm::dmat4& seen_from_rel,
                                  const glm::dvec3& camera_m, const DepthBias& bias) {
    LOAM_CHECK(camera_m == patches.camera_m, "patches were selected for another camera");
    const std::vector<uint32_t> seen = patches_in(patches, heights, seen_from_rel);
    if (!instances_.data || seen.empty()) return;
    bind(commands, shadow_, patches, heights, glm::mat4(clip_from_rel), false);
    vkCmdSetDepthBias(commands.handle(), bias.constant, 0.0f, bias.slope);
    for (size_t begin = 0, end = 0; begin < seen.size();
         begin = end) {  // a draw a run of neighbouring instances
        for (end = begin + 1; end < seen.size() && seen[end] == seen[end - 1] + 1; ++end) {
        }
        vkCmdDrawIndexed(commands.handle(), kIndexCount, uint32_t(end - begin), 0, 0, seen[begin]);
    }
}

}  // namespace loam
