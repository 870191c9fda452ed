#include "runtime/gpu/access.h"

namespace loam::gpu {

namespace {

constexpr VkAccessFlags2 kShaderRead =
    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
constexpr VkAccessFlags2 kStorage =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
constexpr VkPipelineStageFlags2 kDepthStages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

}  // namespace

// Every shader read states the same kinds of access. That keeps SyncState exact: the union of what several
// barriers made visible never claims a pair of stage and access that none of them covered.
AccessInfo access_info(Access access) {
    switch (access) {
        case Access::undefined:
            return {VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED, false};
        case Access::copy_source:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false};
        case Access::copy_target:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, true};
        case Access::compute_sampled:
            return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kShaderRead,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false};
        case Access::compute_storage:
            return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kStorage, VK_IMAGE_LAYOUT_GENERAL, true};
        case Access::vertex_read:
            return {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, kShaderRead,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false};
        case Access::fragment_sampled:
            return {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, kShaderRead,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false};
        case Access::graphics_read:
            return {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                    kShaderRead, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false};
        case Access::fragment_storage:
            return {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, kStorage, VK_IMAGE_LAYOUT_GENERAL, true};
        case Access::color_target:
            return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, true};
        case Access::depth_target:
            return {kDepthStages,
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, true};
        case Access::depth_sampled:
            return {kDepthStages | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | kShaderRead,
                    VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, false};
        case Access::indirect_args:
            return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                    VK_IMAGE_LAYOUT_GENERAL, false};
        case Access::index_buffer:
            return {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_GENERAL,
                    false};
        case Access::host_read:
            return {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_GENERAL, false};
        case Access::present:
            // The stages are those at which a frame waits for the acquired image, so that barriers on either
            // side of the presentation chain with the semaphores.
            return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
                    VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, false};
    }
    return {};
}

bool needs_barrier(Access before, Access after, bool is_image) {
    const AccessInfo a = access_info(before), b = access_info(after);
    if (after == Access::undefined) return false;
    if (is_image && a.layout != b.layout) return true;
    if (before == Access::undefined) return false;
    return a.writes || b.writes;
}

SyncState state_after(Access access) {
    const AccessInfo info = access_info(access);
    SyncState state{
        .write_stages = info.stages, .write_access = info.access & kWrites, .layout = info.layout};
    if (!info.writes) {
        state.read_stages = state.visible_stages = info.stages;
        state.visible_access = info.access;
    }
    return state;
}

std::optional<BarrierMasks> advance(SyncState& state, Access next, bool is_image) {
    const AccessInfo info = access_info(next);
    if (next == Access::undefined) {  // contents given up; who used it last still matters
        state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        return std::nullopt;
    }
    const bool new_layout = is_image && state.layout != info.layout;
    BarrierMasks barrier{.source_stages = state.write_stages,
                         .source_access = state.write_access,
                         .target_stages = info.stages,
                         .target_access = info.access,
                         .old_layout = state.layout,
                         .new_layout = info.layout};
    if (info.writes || new_layout) {  // a change of layout is a write
        barrier.source_stages |= state.read_stages;
        state = state_after(next);
        if (barrier.source_stages == 0 && !new_layout) return std::nullopt;
        return barrier;
    }
    state.read_stages |= info.stages;
    const bool visible =
        (info.stages & ~state.visible_stages) == 0 && (info.access & ~state.visible_access) == 0;
    if (state.write_stages == 0 || visible) return std::nullopt;
    state.visible_stages |= info.stages;
    state.visible_access |= info.access;
    return barrier;
}

}  // namespace loam::gpu
