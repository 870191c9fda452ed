// Images, buffers, samplers. Move-only; destruction retires the raw handle to the device.
// An image or buffer remembers how it was used; Commands::use() makes the barrier from that. Set `last_access` to
// undefined to say that the contents are not needed any more.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/gpu/access.h"
#include "runtime/gpu/device.h"

namespace loam::gpu {

struct ImageDesc {
    std::string_view name;
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 1, height = 1;
    uint32_t mip_count = 1;
    uint32_t layer_count = 1;  // > 1: its default view is a 2D array
    bool array_view = false;   // make the default view a 2D array even with one layer
    VkImageUsageFlags usage = 0; // transfer usages are always added
    // A second view of the same bytes in another format (for instance RG32_UINT over BC1); UNDEFINED: none.
    VkFormat alias_format = VK_FORMAT_UNDEFINED;
};

class Image {
  public:
    static Result<Image> create(Device& device, const ImageDesc& desc);
    Image() = default;
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;
    ~Image();

    [[nodiscard]] explicit operator bool() const { return image_ != VK_NULL_HANDLE; }
    [[nodiscard]] VkImage handle() const { return image_; }
    [[nodiscard]] VkImageView view() const { return view_; }                      // all mips and layers
    [[nodiscard]] VkImageView mip_view(uint32_t mip) const { return mip_views_[mip]; } // one mip, all layers; storage, targets
    // One mip of one layer, to render into it (shadow cascades): images with layers and an attachment usage.
    [[nodiscard]] VkImageView layer_view(uint32_t mip, uint32_t layer) const {
        return layer_views_[size_t(mip) * layer_count_ + layer];
    }
    [[nodiscard]] VkImageView depth_view() const { return depth_view_; }   // depth aspect only, for sampling
    [[nodiscard]] VkImageView stencil_view() const { return stencil_view_; }
    // All layers, but of a compressed image one layer only: Vulkan allows no array of texel views of blocks.
    [[nodiscard]] VkImageView alias_view(uint32_t mip, uint32_t layer = 0) const {
        return alias_views_[size_t(mip) * alias_layers_ + layer];
    }
    [[nodiscard]] VkFormat format() const { return format_; }
    [[nodiscard]] uint32_t width() const { return width_; }
    [[nodiscard]] uint32_t height() const { return height_; }
    [[nodiscard]] uint32_t mip_count() const { return mip_count_; }
    [[nodiscard]] uint32_t layer_count() const { return layer_count_; }
    [[nodiscard]] VkImageAspectFlags aspect() const;
    [[nodiscard]] uint64_t bytes() const { return allocation_.size; }

    Access last_access = Access::undefined; // kept by Commands
    SyncState sync;                         // kept by Commands

  private:
    Status make_views(const ImageDesc& desc, VkImageUsageFlags usage);
    void swap(Image& other) noexcept;
    void retire();
    Device* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE, depth_view_ = VK_NULL_HANDLE, stencil_view_ = VK_NULL_HANDLE;
    std::vector<VkImageView> mip_views_, layer_views_, alias_views_;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    uint32_t width_ = 0, height_ = 0, mip_count_ = 1, layer_count_ = 1, alias_layers_ = 1;
    Allocation allocation_;
};

struct BufferDesc {
    std::string_view name;
    uint64_t size_bytes = 0;
    VkBufferUsageFlags usage = 0; // transfer usages are always added
    MemoryUse memory = MemoryUse::device;
};

class Buffer {
  public:
    static Result<Buffer> create(Device& device, const BufferDesc& desc);
    Buffer() = default;
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;
    ~Buffer();

    [[nodiscard]] explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
    [[nodiscard]] VkBuffer handle() const { return buffer_; }
    [[nodiscard]] uint64_t size_bytes() const { return size_bytes_; }
    [[nodiscard]] void* mapped() const { return allocation_.mapped; } // upload and readback memory (coherent)
    template <typename T>
    [[nodiscard]] T* as() const { return static_cast<T*>(allocation_.mapped); }

    Access last_access = Access::undefined; // kept by Commands
    SyncState sync;                         // kept by Commands

  private:
    void swap(Buffer& other) noexcept;
    void retire();
    Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    uint64_t size_bytes_ = 0;
    Allocation allocation_;
};

struct SamplerDesc {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerMipmapMode mip_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    float max_anisotropy = 1.0f;                          // > 1 enables it, limited to the device's
    bool compare_greater = false;                         // reversed-Z shadow compare: 1 where reference >= texel
    float max_lod = VK_LOD_CLAMP_NONE;
    bool operator==(const SamplerDesc&) const = default;
};

class Sampler {
  public:
    static Result<Sampler> create(Device& device, const SamplerDesc& desc);
    Sampler() = default;
    Sampler(Sampler&& other) noexcept;
    Sampler& operator=(Sampler&& other) noexcept;
    ~Sampler();
    [[nodiscard]] VkSampler handle() const { return sampler_; }

  private:
    Device* device_ = nullptr;
    VkSampler sampler_ = VK_NULL_HANDLE;
};

} // namespace loam::gpu
