// How a pass uses a resource, and the barrier between two uses: a pure function, so it is tested without a device.
#pragma once

#include <vulkan/vulkan_core.h>

namespace loam::gpu {

enum class Access {
    undefined,       // contents not needed
    copy_source,     // vkCmdCopy*, vkCmdBlit*
    copy_target,
    compute_sampled, // sampled image or uniform/storage buffer read in a compute shader
    compute_storage, // storage image or buffer, read and written, in a compute shader (GENERAL)
    vertex_read,     // sampled image or buffer read in a vertex shader
    fragment_sampled,
    graphics_read,   // in vertex and fragment shaders
    fragment_storage,
    color_target,    // blending reads included
    depth_target,    // depth and stencil, tested and written
    depth_sampled,   // sampled in fragment or compute while bound read-only for depth and stencil test
    indirect_args,
    index_buffer,
    host_read,
    present,
};

struct AccessInfo {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
    VkImageLayout layout;
    bool writes;
};

[[nodiscard]] AccessInfo access_info(Access access);
// Whether a barrier is needed between the two (any write involved, or a change of layout).
[[nodiscard]] bool needs_barrier(Access before, Access after, bool is_image);

} // namespace loam::gpu
