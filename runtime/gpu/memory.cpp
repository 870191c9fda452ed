#include "runtime/gpu/memory.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include "runtime/base/check.h"
#include "runtime/base/log.h"

namespace loam::gpu {

namespace {
constexpr uint64_t kBlockSize_bytes = 64ull << 20;
constexpr uint64_t kDedicatedAbove_bytes = 32ull << 20;  // half a block: more would waste the rest of it
}  // namespace

std::optional<uint64_t> FreeList::allocate(uint64_t size, uint64_t alignment) {
    LOAM_CHECK(size > 0 && std::has_single_bit(alignment),
               fmt::format("size {} alignment {}", size, alignment));
    for (auto it = free_.begin(); it != free_.end(); ++it) {
        const auto [begin, length] = *it;
        const uint64_t offset = (begin + alignment - 1) & ~(alignment - 1);
        const uint64_t gap = offset - begin;
        if (gap >= length || length - gap < size) continue;
        const uint64_t rest = length - gap - size;
        if (gap > 0)
            it->second = gap;
        else
            free_.erase(it);
        if (rest > 0) free_.emplace(offset + size, rest);
        free_bytes_ -= size;
        return offset;
    }
    return std::nullopt;
}

void FreeList::release(uint64_t offset, uint64_t size) {
    LOAM_CHECK(size > 0 && offset + size <= size_, fmt::format("range {} + {} of {}", offset, size, size_));
    auto next = free_.lower_bound(offset);
    LOAM_CHECK(next == free_.end() || offset + size <= next->first, "range was free already");
    free_bytes_ += size;
    if (next != free_.begin()) {
        const auto previous = std::prev(next);
        LOAM_CHECK(previous->first + previous->second <= offset, "range was free already");
        if (previous->first + previous->second == offset) {
            offset = previous->first;
            size += previous->second;
            free_.erase(previous);
        }
    }
    if (next != free_.end() && offset + size == next->first) {
        size += next->second;
        free_.erase(next);
    }
    free_.emplace(offset, size);
}

MemoryPools::MemoryPools(VkPhysicalDevice physical, VkDevice device) : device_(device) {
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
}

MemoryPools::~MemoryPools() {
    for (Pool& pool : pools_)
        for (Block& block : pool.blocks) {
            if (block.memory == VK_NULL_HANDLE) continue;
            if (!block.ranges.empty())
                log(LogLevel::error, "GPU memory outlives its device: an object leaked");
            free_block(block);
        }
}

void MemoryPools::free_block(Block& block) {
    vkFreeMemory(device_, block.memory, nullptr);
    block = Block{};
}

// Types that can serve at all, best first. The order among equals is the driver's, which puts the fastest
// first.
std::vector<uint32_t> MemoryPools::types_by_preference(uint32_t type_bits, MemoryUse use) const {
    constexpr VkMemoryPropertyFlags kHost =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags required = use == MemoryUse::device ? 0 : kHost;
    const auto rank = [&](uint32_t type) {
        const VkMemoryPropertyFlags flags = properties_.memoryTypes[type].propertyFlags;
        const bool local = flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
        const bool cached = flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
        if (use == MemoryUse::device) return local ? 0 : 1;
        if (use == MemoryUse::readback) return (cached ? 0 : 2) + (local ? 1 : 0);
        return (cached ? 2 : 0) + (local ? 1 : 0);  // upload: written once by the CPU; leave the small mapped
                                                    // window of device memory to others
    };
    std::vector<uint32_t> types;
    for (uint32_t type = 0; type < properties_.memoryTypeCount; ++type) {
        const VkMemoryPropertyFlags flags = properties_.memoryTypes[type].propertyFlags;
        constexpr VkMemoryPropertyFlags kUnfit =
            VK_MEMORY_PROPERTY_PROTECTED_BIT | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT;
        if ((type_bits & (1u << type)) && (flags & required) == required && !(flags & kUnfit))
            types.push_back(type);
    }
    std::ranges::stable_sort(types, {}, rank);
    return types;
}

uint32_t MemoryPools::find_pool(uint32_t type, MemoryUse use, bool linear) {
    for (uint32_t i = 0; i < pools_.size(); ++i)
        if (pools_[i].type == type && pools_[i].use == use && pools_[i].linear == linear) return i;
    pools_.push_back({.type = type, .use = use, .linear = linear, .blocks = {}});
    return static_cast<uint32_t>(pools_.size() - 1);
}

Result<uint32_t> MemoryPools::add_block(Pool& pool, uint64_t size) {
    const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    .pNext = nullptr,
                                    .allocationSize = size,
                                    .memoryTypeIndex = pool.type};
    Block block{.ranges = FreeList(size)};
    if (const VkResult r = vkAllocateMemory(device_, &info, nullptr, &block.memory); r != VK_SUCCESS)
        return vk_error(fmt::format("allocating {} MiB of GPU memory", size >> 20), r);
    if (pool.use != MemoryUse::device) {
        const VkResult r = vkMapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &block.mapped);
        if (r != VK_SUCCESS) {
            vkFreeMemory(device_, block.memory, nullptr);
            return vk_error("mapping GPU memory", r);
        }
    }
    auto slot = std::ranges::find(pool.blocks, VkDeviceMemory(VK_NULL_HANDLE), &Block::memory);
    if (slot == pool.blocks.end()) slot = pool.blocks.insert(slot, Block{});
    *slot = std::move(block);
    return static_cast<uint32_t>(slot - pool.blocks.begin());
}

Result<Allocation> MemoryPools::allocate_from(uint32_t pool_index, uint64_t size, uint64_t alignment) {
    Pool& pool = pools_[pool_index];
    const auto take = [&](uint32_t index) -> std::optional<Allocation> {
        Block& block = pool.blocks[index];
        if (block.memory == VK_NULL_HANDLE) return std::nullopt;
        const auto offset = block.ranges.allocate(size, alignment);
        if (!offset) return std::nullopt;
        return Allocation{.memory = block.memory,
                          .offset = *offset,
                          .size = size,
                          .mapped = block.mapped ? static_cast<std::byte*>(block.mapped) + *offset : nullptr,
                          .block = index,
                          .pool = pool_index};
    };
    const bool dedicated = size > kDedicatedAbove_bytes;
    if (!dedicated)
        for (uint32_t i = 0; i < pool.blocks.size(); ++i)
            if (auto found = take(i)) return *found;
    auto added = add_block(pool, dedicated ? size : kBlockSize_bytes);
    // Nearly full: a block of just this size may still fit.
    if (!added.ok() && !dedicated) added = add_block(pool, size);
    if (!added.ok()) return added.error();
    return *take(*added);
}

Result<Allocation> MemoryPools::allocate(const VkMemoryRequirements& needs, MemoryUse use, bool linear) {
    Error last = error("no memory type of the device fits");
    for (const uint32_t type : types_by_preference(needs.memoryTypeBits, use)) {
        auto got = allocate_from(find_pool(type, use, linear), needs.size, needs.alignment);
        if (got.ok()) {
            used_bytes_[static_cast<size_t>(use)] += needs.size;
            return got;
        }
        last = got.error();
    }
    return last;
}

void MemoryPools::release(const Allocation& allocation) {
    if (allocation.memory == VK_NULL_HANDLE) return;
    Pool& pool = pools_[allocation.pool];
    Block& block = pool.blocks[allocation.block];
    LOAM_CHECK(block.memory == allocation.memory, "allocation released twice");
    block.ranges.release(allocation.offset, allocation.size);
    used_bytes_[static_cast<size_t>(pool.use)] -= allocation.size;
    if (!block.ranges.empty()) return;
    // One empty ordinary block stays, so that a size going back and forth does not allocate each time.
    const bool ordinary = block.ranges.free_bytes() == kBlockSize_bytes;
    const bool has_spare = std::ranges::any_of(pool.blocks, [&](const Block& other) {
        return &other != &block && other.memory != VK_NULL_HANDLE && other.ranges.empty();
    });
    if (!ordinary || has_spare) free_block(block);
}

}  // namespace loam::gpu
