// What one frame in flight owns. Internal to runtime/gpu.
#pragma once

#include "runtime/gpu/frame_ring.h"

namespace loam::gpu {

// Host memory handed out in order and taken back all at once.
class HostRing {
  public:
    HostRing(const char* name, MemoryUse use) : name_(name), use_(use) {}
    Result<UploadSlice> take(Device& device, uint64_t size_bytes);
    void reset();  // also frees big blocks that the last round did not use
    [[nodiscard]] uint64_t bytes() const;

  private:
    struct Block {
        std::unique_ptr<Buffer> buffer;  // slices point to it
        uint64_t used = 0;
    };
    const char* name_;
    MemoryUse use_;
    std::vector<Block> blocks_;
};

struct FrameRing::Slot {
    struct Readback {
        UploadSlice slice;
        std::function<void(std::span<const std::byte>)> done;
    };
    Frame frame;
    bool pending = false;  // submitted, and not yet delivered
    VkCommandPool command_pool = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE;
    std::vector<const char*> pass_names;  // pass i has the queries 2 i and 2 i + 1
    std::vector<VkDescriptorPool> descriptor_pools;
    size_t descriptor_pool = 0;  // the one allocated from
    HostRing uploads{"upload ring", MemoryUse::upload};
    HostRing readback_memory{"readback ring", MemoryUse::readback};
    std::vector<Readback> readbacks;
};

}  // namespace loam::gpu
