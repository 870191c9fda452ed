#include "runtime/geometry/terrain_pass.h"

#include "runtime/base/check.h"

#include <algorithm>
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

gpu::GraphicsDesc prepass_pipeline(const char* name, const char* fragment_shader,
                                   const std::vector<VkFormat>& color_formats, VkFormat depth_stencil) {
    gpu::GraphicsDesc desc = patch_pipeline(name, depth_stencil);
    desc.fragment_shader = fragment_shader;
    desc.bindings.push_back(gpu::sampled_image(2));
    desc.color_formats = color_formats;
    desc.stencil.enable = true;
    desc.stencil.pass = VK_STENCIL_OP_REPLACE;
    desc.stencil.reference = 1;
    return desc;
}

}  // namespace

Result<TerrainPass> TerrainPass::create(gpu::Device& device, const std::vector<VkFormat>& color_formats,
                                        VkFormat depth_stencil, VkFormat shadow_depth) {
    static_assert(sizeof(shared::GeometryPush) <= 128);
    TerrainPass pass;
    pass.device_ = &device;
    pass.color_formats_ = color_formats;
    pass.depth_stencil_ = depth_stencil;
    pass.shadow_depth_ = shadow_depth;
    auto prepass = gpu::Pipeline::create(
        device,
        prepass_pipeline("terrain prepass", "geometry/terrain_prepass.frag", color_formats, depth_stencil));
    if (!prepass) return prepass.error();
    pass.prepass_ = std::move(*prepass);

    gpu::GraphicsDesc desc = patch_pipeline("terrain shadow", shadow_depth);
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

Status TerrainPass::create_cut_pipelines() {
    const auto with_cutouts = [](gpu::GraphicsDesc desc) {
        desc.bindings.push_back(gpu::storage_buffer(3));
        desc.bindings.push_back(gpu::storage_buffer(4));
        return desc;
    };
    auto prepass = gpu::Pipeline::create(
        *device_,
        with_cutouts(prepass_pipeline("terrain prepass with holes", "geometry/terrain_prepass_cut.frag",
                                      color_formats_, depth_stencil_)));
    if (!prepass) return prepass.error();
    gpu::GraphicsDesc desc = with_cutouts(patch_pipeline("terrain shadow with holes", shadow_depth_));
    desc.fragment_shader = "geometry/terrain_shadow_cut.frag";
    desc.depth_bias = true;
    auto shadow = gpu::Pipeline::create(*device_, desc);
    if (!shadow) return shadow.error();
    prepass_cut_ = std::move(*prepass);
    shadow_cut_ = std::move(*shadow);
    return {};
}

Status TerrainPass::upload(gpu::FrameRing& ring, gpu::Commands&, const PatchSet& patches) {
    instances_ = {};
    if (patches.patches.empty()) return {};
    if (!prepass_cut_ && patches.visible_cut + patches.hidden_cut > 0) LOAM_TRY(create_cut_pipelines());
    const uint64_t bytes = patches.patches.size() * sizeof(shared::PatchInstance);
    instances_ = ring.upload(bytes);
    if (!instances_.data) return error("no memory for {} terrain patches", patches.patches.size());
    std::memcpy(instances_.data, patches.patches.data(), bytes);
    return {};
}

void TerrainPass::bind(gpu::Commands& commands, const gpu::Pipeline& pipeline, const PatchSet& patches,
                       const HeightMap& heights, const glm::mat4& clip_from_rel) {
    std::vector<gpu::Bound> bound;
    const bool cuts = &pipeline == &prepass_cut_ || &pipeline == &shadow_cut_;
    bound.emplace_back(0, *instances_.buffer, instances_.offset,
                       patches.patches.size() * sizeof(shared::PatchInstance));
    bound.emplace_back(1, heights.heights().view(), nearest_);
    if (&pipeline != &shadow_ && &pipeline != &shadow_cut_)
        bound.emplace_back(2, heights.normals().view(), linear_);
    if (cuts) {
        bound.emplace_back(3, patches.cutouts->table());
        bound.emplace_back(4, patches.cutouts->pages());
    }
    commands.bind(pipeline, bound);

    shared::GeometryPush push{};
    push.clip_from_rel = clip_from_rel;
    push.origin_rel_m = glm::vec2(patches.origin_rel_m);
    push.step_m = static_cast<float>(patches.step_m);
    push.camera_z_m = static_cast<float>(patches.camera_m.z);
    push.map_edge_rel_m = glm::vec2(patches.map_edge_rel_m);
    if (cuts) push.cutout = patches.cutouts->push(patches.camera_m);
    commands.push(pipeline, push);
    vkCmdBindIndexBuffer(commands.handle(), indices_.handle(), 0, VK_INDEX_TYPE_UINT16);
}

void TerrainPass::cmd_draw_prepass(gpu::Commands& commands, const PatchSet& patches, const HeightMap& heights,
                                   const glm::mat4& clip_from_rel, const glm::dvec3& camera_m) {
    LOAM_CHECK(camera_m == patches.camera_m, "patches were selected for another camera");
    if (!instances_.data || patches.visible_count == 0) return;
    const auto whole = uint32_t(patches.visible_count - patches.visible_cut),
               cut = uint32_t(patches.visible_cut);
    if (whole > 0) {
        bind(commands, prepass_, patches, heights, clip_from_rel);
        vkCmdDrawIndexed(commands.handle(), kIndexCount, whole, 0, 0, 0);
    }
    if (cut > 0) {
        bind(commands, prepass_cut_, patches, heights, clip_from_rel);
        vkCmdDrawIndexed(commands.handle(), kIndexCount, cut, 0, 0, whole);
    }
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
    bind(commands, levels_, patches, heights, clip_from_rel);
    vkCmdDrawIndexed(commands.handle(), kIndexCount, uint32_t(patches.visible_count), 0, 0, 0);
    return {};
}

void TerrainPass::cmd_draw_shadow(gpu::Commands& commands, const PatchSet& patches, const HeightMap& heights,
                                  const glm::dmat4& clip_from_rel, const glm::dmat4& seen_from_rel,
                                  const glm::dvec3& camera_m, const DepthBias& bias) {
    LOAM_CHECK(camera_m == patches.camera_m, "patches were selected for another camera");
    const std::vector<uint32_t> seen = patches_in(patches, heights, seen_from_rel);
    if (!instances_.data || seen.empty()) return;
    for (const bool cut : {false, true}) {
        const auto is_of_pass = [&](uint32_t patch) { return patches.has_holes(patch) == cut; };
        if (std::none_of(seen.begin(), seen.end(), is_of_pass)) continue;
        bind(commands, cut ? shadow_cut_ : shadow_, patches, heights, glm::mat4(clip_from_rel));
        vkCmdSetDepthBias(commands.handle(), bias.constant, 0.0f, bias.slope);
        for (size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
            end = begin + 1;
            if (!is_of_pass(seen[begin])) continue;
            // A draw a run of neighbouring instances.
            while (end < seen.size() && seen[end] == seen[end - 1] + 1 && is_of_pass(seen[end])) ++end;
            vkCmdDrawIndexed(commands.handle(), kIndexCount, uint32_t(end - begin), 0, 0, seen[begin]);
        }
    }
}

}  // namespace loam
