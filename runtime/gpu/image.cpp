#include <utility>

#include "runtime/base/check.h"
#include "runtime/gpu/format.h"
#include "runtime/gpu/resources.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

namespace {

constexpr VkImageUsageFlags kTransfer = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr VkImageUsageFlags kAttachment =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;

// What a view in this format may be used for: an aliased image carries usages that only one of its formats
// has.
VkImageUsageFlags supported_usage(VkPhysicalDevice physical, VkFormat format) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(physical, format, &properties);
    const VkFormatFeatureFlags has = properties.optimalTilingFeatures;
    VkImageUsageFlags usage = kTransfer;
    if (has & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    if (has & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    if (has & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (has & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT)
        usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    return usage;
}

struct ViewRange {
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    uint32_t mip = 0, mip_count = 1, layer = 0, layer_count = 1;
    bool array = false;
};

Status make_view(VkDevice device, VkImage image, VkFormat format, const ViewRange& range,
                 VkImageUsageFlags usage, VkImageView& out) {
    auto narrowed = vk_struct<VkImageViewUsageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO);
    narrowed.usage = usage;
    auto info = vk_struct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    info.pNext = &narrowed;
    info.image = image;
    info.viewType = range.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {range.aspect, range.mip, range.mip_count, range.layer, range.layer_count};
    const VkResult r = vkCreateImageView(device, &info, nullptr, &out);
    if (r != VK_SUCCESS) return vk_error("vkCreateImageView", r);
    return {};
}

Status check_limits(VkPhysicalDevice physical, const ImageDesc& desc, const VkImageCreateInfo& info) {
    VkImageFormatProperties limits;
    const VkResult r = vkGetPhysicalDeviceImageFormatProperties(physical, info.format, info.imageType,
                                                                info.tiling, info.usage, info.flags, &limits);
    if (r != VK_SUCCESS)
        return error("image \"{}\": the device does not support format {} with usage {:#x}", desc.name,
                     static_cast<int>(info.format), info.usage);
    if (desc.width > limits.maxExtent.width || desc.height > limits.maxExtent.height)
        return error("image \"{}\" is {} x {}, the device allows {} x {}", desc.name, desc.width, desc.height,
                     limits.maxExtent.width, limits.maxExtent.height);
    if (desc.layer_count > limits.maxArrayLayers)
        return error("image \"{}\" has {} layers, the device allows {}", desc.name, desc.layer_count,
                     limits.maxArrayLayers);
    if (desc.mip_count > limits.maxMipLevels)
        return error("image \"{}\" has {} mips, the device allows {}", desc.name, desc.mip_count,
                     limits.maxMipLevels);
    return {};
}

}  // namespace

Result<Image> Image::create(Device& device, const ImageDesc& desc) {
    LOAM_CHECK(desc.width > 0 && desc.height > 0 && desc.mip_count > 0 && desc.layer_count > 0,
               std::string(desc.name));
    const bool aliased = desc.alias_format != VK_FORMAT_UNDEFINED;
    const bool compressed = format_info(desc.format).block_size_texel > 1;
    const VkFormat formats[] = {desc.format, desc.alias_format};
    auto list = vk_struct<VkImageFormatListCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_FORMAT_LIST_CREATE_INFO);
    list.viewFormatCount = 2;
    list.pViewFormats = formats;
    auto info = vk_struct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = desc.mip_count;
    info.arrayLayers = desc.layer_count;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = desc.usage | kTransfer;
    if (aliased) {
        info.pNext = &list;
        info.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
        if (compressed) info.flags |= VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT;
    }
    LOAM_TRY(check_limits(device.physical(), desc, info));

    Image image;
    image.device_ = &device;
    image.format_ = desc.format;
    image.width_ = desc.width;
    image.height_ = desc.height;
    image.mip_count_ = desc.mip_count;
    image.layer_count_ = desc.layer_count;
    image.alias_layers_ = compressed ? desc.layer_count : 1;
    if (const VkResult r = vkCreateImage(device.handle(), &info, nullptr, &image.image_); r != VK_SUCCESS)
        return vk_error(fmt::format("creating image \"{}\"", desc.name), r);
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device.handle(), image.image_, &needs);
    auto memory = device.allocate(needs, MemoryUse::device, false);
    if (!memory) return error("image \"{}\": {}", desc.name, memory.message());
    image.allocation_ = *memory;
    const VkResult r =
        vkBindImageMemory(device.handle(), image.image_, image.allocation_.memory, image.allocation_.offset);
    if (r != VK_SUCCESS) return vk_error(fmt::format("binding image \"{}\"", desc.name), r);
    device.set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(image.image_), desc.name);
    if (Status s = image.make_views(desc, info.usage); !s)
        return error("image \"{}\": {}", desc.name, s.message());
    return image;
}

Status Image::make_views(const ImageDesc& desc, VkImageUsageFlags usage) {
    const VkDevice device = device_->handle();
    constexpr VkImageUsageFlags kViewable =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | kAttachment;
    if (!(usage & kViewable)) return {};  // copies only: a view would be invalid
    const bool array = desc.array_view || layer_count_ > 1;
    const VkImageUsageFlags own = usage & supported_usage(device_->physical(), format_);
    const VkImageAspectFlags all = aspect();

    // A view must name a use beyond copies: of a format that only its alias makes useful there is none.
    if (own & kViewable) {
        LOAM_TRY(
            make_view(device, image_, format_, {all, 0, mip_count_, 0, layer_count_, array}, own, view_));
        mip_views_.resize(mip_count_);
        for (uint32_t mip = 0; mip < mip_count_; ++mip)
            LOAM_TRY(make_view(device, image_, format_, {all, mip, 1, 0, layer_count_, array}, own,
                               mip_views_[mip]));
        if (all & VK_IMAGE_ASPECT_DEPTH_BIT)
            LOAM_TRY(make_view(device, image_, format_,
                               {VK_IMAGE_ASPECT_DEPTH_BIT, 0, mip_count_, 0, layer_count_, array}, own,
                               depth_view_));
        if (all & VK_IMAGE_ASPECT_STENCIL_BIT)
            LOAM_TRY(make_view(device, image_, format_,
                               {VK_IMAGE_ASPECT_STENCIL_BIT, 0, mip_count_, 0, layer_count_, array}, own,
                               stencil_view_));
    }
    if (layer_count_ > 1 && (own & kAttachment)) {
        layer_views_.resize(size_t(mip_count_) * layer_count_);
        for (uint32_t i = 0; i < layer_views_.size(); ++i)
            LOAM_TRY(make_view(device, image_, format_,
                               {all, i / layer_count_, 1, i % layer_count_, 1, false}, own, layer_views_[i]));
    }
    if (desc.alias_format != VK_FORMAT_UNDEFINED) {
        const VkImageUsageFlags other = usage & supported_usage(device_->physical(), desc.alias_format);
        const uint32_t layers = alias_layers_ > 1 ? 1 : layer_count_;  // of one view
        alias_views_.resize(size_t(mip_count_) * alias_layers_);
        for (uint32_t i = 0; i < alias_views_.size(); ++i)
            LOAM_TRY(make_view(device, image_, desc.alias_format,
                               {VK_IMAGE_ASPECT_COLOR_BIT, i / alias_layers_, 1, i % alias_layers_, layers,
                                desc.array_view || layers > 1},
                               other, alias_views_[i]));
    }
    return {};
}

Image::Image(Image&& other) noexcept {
    swap(other);
}

Image& Image::operator=(Image&& other) noexcept {
    Image taken(std::move(other));
    swap(taken);  // what was here is retired with `taken`
    return *this;
}

Image::~Image() {
    retire();
}

void Image::swap(Image& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(view_, other.view_);
    std::swap(depth_view_, other.depth_view_);
    std::swap(stencil_view_, other.stencil_view_);
    std::swap(mip_views_, other.mip_views_);
    std::swap(layer_views_, other.layer_views_);
    std::swap(alias_views_, other.alias_views_);
    std::swap(format_, other.format_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    std::swap(mip_count_, other.mip_count_);
    std::swap(layer_count_, other.layer_count_);
    std::swap(alias_layers_, other.alias_layers_);
    std::swap(allocation_, other.allocation_);
    std::swap(last_access, other.last_access);
    std::swap(sync, other.sync);
}

void Image::retire() {
    if (image_ == VK_NULL_HANDLE) return;
    std::vector<VkImageView> views = std::move(mip_views_);
    views.insert(views.end(), {view_, depth_view_, stencil_view_});
    views.insert(views.end(), layer_views_.begin(), layer_views_.end());
    views.insert(views.end(), alias_views_.begin(), alias_views_.end());
    device_->retire([device = device_, image = image_, allocation = allocation_, views = std::move(views)] {
        for (const VkImageView view : views) vkDestroyImageView(device->handle(), view, nullptr);
        vkDestroyImage(device->handle(), image, nullptr);
        device->release(allocation);
    });
    image_ = VK_NULL_HANDLE;
}

VkImageAspectFlags Image::aspect() const {
    return format_aspect(format_);
}

}  // namespace loam::gpu
