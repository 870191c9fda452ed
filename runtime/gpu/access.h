// How a pass uses a resource, and the barrier between two uses: a pure function, so it is tested without a device.
//
// A resource keeps a SyncState: its last write, and which reads of it are already ordered after that write. So a
// second reading stage gets its own barrier against the write, reads never wait for reads, and a write waits for
// all of them. Layouts are tracked for the whole image: a pass that reads one mip and writes another uses
// compute_storage and samples in GENERAL.
#pragma once

#include <optional>

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

struct SyncState {
    VkPipelineStageFlags2 write_stages = 0; // of the last write or change of layout; 0: none yet
    VkAccessFlags2 write_access = 0;
    VkPipelineStageFlags2 read_stages = 0;    // all reads since
    VkPipelineStageFlags2 visible_stages = 0; // where the write is visible already …
    VkAccessFlags2 visible_access = 0;        // … and to which kinds of access
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

struct BarrierMasks {
    VkPipelineStageFlags2 source_stages = 0;
    VkAccessFlags2 source_access = 0;
    VkPipelineStageFlags2 target_stages = 0;
    VkAccessFlags2 target_access = 0;
    VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED, new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// The state of a resource of which only the last use is known (set by hand, or outside Commands).
[[nodiscard]] SyncState state_after(Access access);
// Moves the state to the next use and returns the barrier that has to come first, if any.
[[nodiscard]] std::optional<BarrierMasks> advance(SyncState& state, Access next, bool is_image);

} // namespace loam::gpu
