// Device memory in blocks of 64 MiB, cut up by a first-fit free list.
//
// Pools are keyed by (memory type, use, linear or optimal): buffers and optimal images never share a block,
// so bufferImageGranularity needs no thought. Anything above 32 MiB gets a block of its own. One thread only.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/base/result.h"
#include "runtime/gpu/device.h"

namespace loam::gpu {

// Offsets in [0, size): knows nothing of Vulkan. First fit keeps the low end dense, so that the blocks at the
// end of a pool run empty and can be given back.
class FreeList {
  public:
    explicit FreeList(uint64_t size) : size_(size), free_bytes_(size) { free_.emplace(0, size); }

    // `alignment` is a power of two. The gap an alignment leaves stays free.
    [[nodiscard]] std::optional<uint64_t> allocate(uint64_t size, uint64_t alignment);
    void release(uint64_t offset, uint64_t size);  // exactly what was allocated

    [[nodiscard]] uint64_t free_bytes() const { return free_bytes_; }
    [[nodiscard]] bool empty() const { return free_bytes_ == size_; }  // nothing allocated
    [[nodiscard]] size_t range_count() const { return free_.size(); }

  private:
    std::map<uint64_t, uint64_t> free_;  // offset → size; never adjacent to one another
    uint64_t size_, free_bytes_;
};

class MemoryPools {
  public:
    MemoryPools(VkPhysicalDevice physical, VkDevice device);
    ~MemoryPools();
    MemoryPools(const MemoryPools&) = delete;
    MemoryPools& operator=(const MemoryPools&) = delete;

    Result<Allocation> allocate(const VkMemoryRequirements& needs, MemoryUse use, bool linear);
    void release(const Allocation& allocation);
    [[nodiscard]] uint64_t used_bytes(MemoryUse use) const { return used_bytes_[static_cast<size_t>(use)]; }

  private:
    struct Block {
        VkDeviceMemory memory = VK_NULL_HANDLE;  // null: the entry can be used again
        void* mapped = nullptr;
        FreeList ranges{0};
    };
    struct Pool {
        uint32_t type = 0;
        MemoryUse use = MemoryUse::device;
        bool linear = true;
        std::vector<Block> blocks;
    };
    Result<Allocation> allocate_from(uint32_t pool_index, uint64_t size, uint64_t alignment);
    Result<uint32_t> add_block(Pool& pool, uint64_t size);
    void free_block(Block& block);
    uint32_t find_pool(uint32_t type, MemoryUse use, bool linear);
    [[nodiscard]] std::vector<uint32_t> types_by_preference(uint32_t type_bits, MemoryUse use) const;

    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_{};
    std::vector<Pool> pools_;
    std::array<uint64_t, 3> used_bytes_{};
};

}  // namespace loam::gpu
